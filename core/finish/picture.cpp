#include "core/finish/picture.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "core/base/text.h"
#include "core/job/output_path.h"

namespace hyades::core {
namespace {

std::vector<std::string> channels_of(std::string_view layer) {
  if (layer == "beauty") return {"R", "G", "B"};
  if (layer == "alpha") return {"A"};
  if (layer == "depth") return {"depth.Z"};
  if (layer == "albedo") return {"albedo.R", "albedo.G", "albedo.B"};
  if (layer == "normal") return {"normal.X", "normal.Y", "normal.Z"};
  if (layer == "variance") return {"variance.R", "variance.G", "variance.B"};
  if (layer == "samples") return {"samples.N"};
  return {};
}

Status write_encoded(PictureFormat format, const OutputDesc& output, const Image& normalised,
                     const std::string& path, const ImageMetadata& metadata) {
  if (format == PictureFormat::exr) {
    const Result<Image> layers = select_layers(normalised, output.layers);
    if (!layers) return layers.error().in("cannot write " + path);
    return write_exr(path, *layers, metadata, output.half);
  }
  const auto curve = find_tone_curve(output.tone_map);
  if (!curve) {
    return Error{fmt::format("cannot write {}: there is no tone_map '{}'; expected {}{}", path,
                             output.tone_map, join_names(tone_curve_names()),
                             did_you_mean(output.tone_map, tone_curve_names()))};
  }
  const bool transparent = output.transparent && format == PictureFormat::png;
  const Result<Image> picture = display_picture(normalised, *curve, output.exposure, transparent);
  if (!picture) return picture.error().in("cannot write " + path);
  return format == PictureFormat::png ? write_png(path, *picture, metadata)
                                      : write_jpeg(path, *picture);
}

}  // namespace

Result<PictureFormat> picture_format(std::string_view file) {
  const std::string ending = file_extension(std::string(file));
  if (ending == ".exr") return PictureFormat::exr;
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".jpg" || ending == ".jpeg") return PictureFormat::jpeg;
  return Error{fmt::format("'{}' has no known ending; expected .exr, .png or .jpg", file)};
}

std::string output_path(const OutputDesc& output, const std::string& folder, int32_t frame) {
  return (std::filesystem::path(folder) / output_path(output.file, frame)).string();
}

Result<Image> select_layers(const Image& normalised, std::span<const std::string> layers) {
  std::vector<std::string> names;
  std::vector<size_t> sources;
  const auto take = [&](const std::string& name) {
    const int source = normalised.find_channel(name);
    if (source < 0) return false;
    names.push_back(name);
    sources.push_back(static_cast<size_t>(source));
    return true;
  };
  if (layers.empty()) {
    for (const char* name : {"R", "G", "B"}) {
      if (!take(name)) return Error{"the film holds no beauty"};
    }
    take("A");
  }
  for (const std::string& layer : layers) {
    const std::vector<std::string> channels = channels_of(layer);
    if (channels.empty()) {
      return Error{fmt::format("there is no layer '{}'; expected {}{}", layer,
                               join_names(layer_names()), did_you_mean(layer, layer_names()))};
    }
    for (const std::string& channel : channels) {
      if (!take(channel)) return Error{fmt::format("the film holds no layer '{}'", layer)};
    }
  }
  Image image = make_image(normalised.width, normalised.height, std::move(names));
  image.placement = normalised.placement;
  const size_t stride = normalised.channels.size();
  for (size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = normalised.data[i / sources.size() * stride + sources[i % sources.size()]];
  }
  return image;
}

Result<Image> display_picture(const Image& normalised, ToneCurve curve, float exposure,
                              bool transparent) {
  const std::vector<std::string> wanted = transparent ? std::vector<std::string>{"beauty", "alpha"}
                                                      : std::vector<std::string>{"beauty"};
  Result<Image> selected = select_layers(normalised, wanted);
  if (!selected) return selected.error();
  Image image = std::move(selected).value();
  const size_t stride = image.channels.size();
  for (size_t i = 0; i < image.data.size(); i += stride) {
    float* pixel = &image.data[i];
    Rgb color(pixel[0], pixel[1], pixel[2]);
    if (transparent) color = pixel[3] > 0.0F ? color / pixel[3] : Rgb(0.0F);
    const Rgb shown = tone_map(color, curve, exposure);
    for (int c = 0; c < 3; ++c) pixel[c] = shown[c];
  }
  return image;
}

Status write_output(const OutputDesc& output, const Image& normalised, const std::string& path,
                    const ImageMetadata& metadata) {
  const Result<PictureFormat> format = picture_format(path);
  if (!format) return format.error();
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{fmt::format("cannot make the folder {}: {}", folder.string(), error.message())};
  }
  return write_encoded(*format, output, normalised, path, metadata);
}

}  // namespace hyades::core
