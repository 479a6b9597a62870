#include "core/finish/frame_outputs.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/finish/cryptomatte.h"
#include "core/finish/denoise.h"
#include "core/finish/picture.h"

namespace hyades::core {
namespace {

/// Writes the outputs of one frame; what several of them need is made once.
class OutputWriter {
 public:
  OutputWriter(const Film& film, Image picture, const ImageMetadata& metadata,
               const DisplayTransform* display)
      : film_(film), picture_(std::move(picture)), metadata_(metadata), display_(display) {
    add_id_channels(film_, picture_);
  }

  Status write(const OutputDesc& output, const std::string& path) {
    const auto format = picture_format(path);
    if (!format) return format.error();
    const bool exr = *format == PictureFormat::exr;
    const auto denoiser = find_denoiser(output.denoise);
    // What shows another layer has nothing to be denoised.
    if (!denoiser || (!exr && !shows_beauty(output)))
      return write_output(output, picture_, path, metadata_of(output), display_);
    const auto clean = denoised(*denoiser);
    if (!clean) return clean.error().in("cannot write " + path);
    if (!exr)
      return write_output(output, with_beauty(**clean), path, metadata_of(output), display_);
    OutputDesc with_layer = output;
    with_layer.layers.emplace_back("denoised");
    return write_output(with_layer, with_denoised_layer(**clean), path, metadata_of(output));
  }

 private:
  /// Made when it is first asked for.
  Result<const Image*> denoised(Denoiser denoiser) {
    if (!clean_.contains(denoiser)) {
      auto clean = denoise(picture_, denoiser);
      if (!clean) return clean.error();
      clean_.emplace(denoiser, std::move(*clean));
    }
    return &clean_.at(denoiser);
  }

  ImageMetadata metadata_of(const OutputDesc& output) const {
    ImageMetadata all = metadata_;
    for (auto& entry : cryptomatte_metadata(film_, output.layers)) all.push_back(std::move(entry));
    return all;
  }

  /// The picture with `clean` in place of its beauty.
  Image with_beauty(const Image& clean) const {
    Image out = picture_;
    const auto first = static_cast<size_t>(out.find_channel("R"));
    for (size_t i = 0; i < clean.data.size() / 3; ++i) {
      for (size_t c = 0; c < 3; ++c)
        out.data[i * out.channels.size() + first + c] = clean.data[3 * i + c];
    }
    return out;
  }

  /// The picture with `clean` beside its beauty.
  Image with_denoised_layer(const Image& clean) const {
    std::vector<std::string> names = picture_.channels;
    for (const char* name : {"denoised.R", "denoised.G", "denoised.B"}) names.emplace_back(name);
    Image out = make_image(picture_.width, picture_.height, std::move(names));
    out.placement = picture_.placement;
    const size_t old = picture_.channels.size();
    for (size_t i = 0; i < clean.data.size() / 3; ++i) {
      std::copy_n(&picture_.data[i * old], old, &out.data[i * (old + 3)]);
      std::copy_n(&clean.data[3 * i], 3, &out.data[i * (old + 3) + old]);
    }
    return out;
  }

  const Film& film_;
  Image picture_;
  const ImageMetadata& metadata_;
  const DisplayTransform* display_;
  std::map<Denoiser, Image> clean_;
};

}  // namespace

Result<std::vector<std::string>> write_outputs(std::span<const OutputDesc> outputs,
                                               const std::string& folder, const FilmInfo& info,
                                               const Film& film, const DisplayTransform* display) {
  ImageMetadata metadata = {
      {"hyades.job", info.job_name},
      {"hyades.frame", std::to_string(info.frame)},
      {"hyades.samples", std::to_string(info.samples)},
      {"hyades.pixels", std::to_string(film.window().area())},
      {"hyades.renderKey", info.render_key},
      {"hyades.class", info.worker_class},
      {"hyades.build", info.build},
  };
  if (const float noise = info.aim.noise; noise > 0) {
    metadata.push_back({"hyades.noise", fmt::format("{}", noise)});
  }
  Image picture = film.normalised();
  const PixelRect& window = film.window();
  if (window != PixelRect{0, 0, info.width, info.height}) {
    picture.placement = {window.x0, window.y0, info.width, info.height};
  }
  OutputWriter writer(film, std::move(picture), metadata, display);
  std::vector<std::string> paths;
  for (const OutputDesc& output : outputs) {
    paths.push_back(output_path(output, folder, info.frame));
    if (auto written = writer.write(output, paths.back()); !written) {
      return written.error();
    }
  }
  return paths;
}

}  // namespace hyades::core
