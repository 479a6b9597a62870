#include "core/finish/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "core/base/text.h"
#include "core/finish/picture_layers.h"
#include "core/job/output_path.h"

namespace hyades::core {
namespace {

/// A picture for displays, and what its file says of it.
struct ForDisplay {
  Image image;
  std::string how;       ///< light became its numbers
  std::string transfer;  ///< "srgb", "linear", "bt709", or "" where it is not known
};

Result<ForDisplay> for_display(const OutputDesc& output, const Image& normalised,
                               const DisplayTransform* display, bool transparent) {
  const auto make = [&](Result<Image> image, const std::string& by,
                        const std::string& transfer) -> Result<ForDisplay> {
    if (!image) return image.error();
    return ForDisplay{
        std::move(*image),
        fmt::format("{}, exposure {}, denoise {}", by, output.exposure, output.denoise), transfer};
  };
  const bool beauty = shows_beauty(output);
  if (display != nullptr) {
    return make(beauty
                    ? display_picture(normalised, *display, output.exposure, transparent)
                    : display_layer(normalised, output.layers.front(), *display, output.exposure),
                display->name(), display->transfer());
  }
  const auto curve = find_tone_curve(output.tone_map);
  if (!curve) {
    return Error{fmt::format("there is no tone_map '{}'; expected {}{}", output.tone_map,
                             join_names(tone_curve_names()),
                             did_you_mean(output.tone_map, tone_curve_names()))};
  }
  return make(beauty ? display_picture(normalised, *curve, output.exposure, transparent)
                     : display_layer(normalised, output.layers.front(), *curve, output.exposure),
              output.tone_map, *curve == ToneCurve::linear ? "linear" : "srgb");
}

ColorTag tag_of(const std::string& transfer) {
  if (transfer == "srgb") return ColorTag::srgb;
  return transfer == "linear" ? ColorTag::linear : ColorTag::none;
}

Status write_encoded(PictureFormat format, const OutputDesc& output, const Image& normalised,
                     const std::string& path, const ImageMetadata& metadata,
                     const DisplayTransform* display) {
  if (format == PictureFormat::exr) {
    const Result<Image> layers = select_layers(normalised, output.layers);
    if (!layers) return layers.error().in("cannot write " + path);
    ImageMetadata texts = metadata;
    if (output.exposure != 0.0F)
      texts.emplace_back(kExposureText, fmt::format("{}", output.exposure));
    return write_exr(path, *layers, texts, output.half);
  }
  const bool transparent = output.transparent && format != PictureFormat::jpeg;
  const auto picture = for_display(output, normalised, display, transparent);
  if (!picture) return picture.error().in("cannot write " + path);
  ImageMetadata texts = metadata;
  texts.emplace_back("hyades.display", picture->how);
  texts.emplace_back("hyades.transfer", picture->transfer.empty() ? "unknown" : picture->transfer);
  const CodeOptions codes{output.bits, tag_of(picture->transfer)};
  switch (format) {
    case PictureFormat::jpeg:
      return write_jpeg(path, picture->image, output.jpeg_quality, texts, codes.color);
    case PictureFormat::tiff:
      return write_tiff(path, picture->image, texts, codes);
    default:
      return write_png(path, picture->image, texts, codes);
  }
}

}  // namespace

Result<PictureFormat> picture_format(std::string_view file) {
  const std::string ending = file_extension(std::string(file));
  if (ending == ".exr") return PictureFormat::exr;
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".jpg" || ending == ".jpeg") return PictureFormat::jpeg;
  if (ending == ".tif" || ending == ".tiff") return PictureFormat::tiff;
  return Error{fmt::format("'{}' has no known ending; expected .exr, .png, .jpg or .tif", file)};
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
    const std::vector<std::string> channels = channels_of(layer, normalised);
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

namespace {

/// Beauty, with straight alpha where `transparent`.
Result<Image> straight_beauty(const Image& normalised, bool transparent) {
  const std::vector<std::string> wanted = transparent ? std::vector<std::string>{"beauty", "alpha"}
                                                      : std::vector<std::string>{"beauty"};
  Result<Image> image = select_layers(normalised, wanted);
  if (!image || !transparent) return image;
  for (size_t i = 0; i < image->data.size(); i += 4) {
    float* pixel = &image->data[i];
    for (int c = 0; c < 3; ++c) pixel[c] = pixel[3] > 0.0F ? pixel[c] / pixel[3] : 0.0F;
  }
  return image;
}

/// Tone-maps colours of linear light, three of each `stride` numbers.
void show(std::vector<float>& data, size_t stride, ToneCurve curve, float exposure) {
  for (size_t i = 0; i < data.size(); i += stride) {
    const Rgb shown = tone_map(Rgb(data[i], data[i + 1], data[i + 2]), curve, exposure);
    for (int c = 0; c < 3; ++c) data[i + static_cast<size_t>(c)] = shown[c];
  }
}

}  // namespace

Result<Image> display_picture(const Image& normalised, ToneCurve curve, float exposure,
                              bool transparent) {
  Result<Image> image = straight_beauty(normalised, transparent);
  if (!image) return image;
  show(image->data, image->channels.size(), curve, exposure);
  return image;
}

Result<Image> display_layer(const Image& normalised, const std::string& layer, ToneCurve curve,
                            float exposure) {
  Result<LayerView> view = view_layer(normalised, layer);
  if (!view) return view.error();
  if (view->is_light) show(view->image.data, view->image.channels.size(), curve, exposure);
  return std::move(view->image);
}

namespace {

/// Colours of linear light, three of each `stride` numbers.
void show(std::vector<float>& data, size_t stride, float exposure) {
  constexpr float kBrightest = 65504.0F;
  const float gain = core::exp2(exposure);
  for (size_t i = 0; i < data.size(); i += stride) {
    for (size_t c = 0; c < 3; ++c) {
      float& value = data[i + c];
      value = value > 0.0F ? std::min(value * gain, kBrightest) : 0.0F;  // NaN too
    }
  }
}

}  // namespace

Result<Image> display_layer(const Image& normalised, const std::string& layer,
                            const DisplayTransform& display, float exposure) {
  Result<LayerView> view = view_layer(normalised, layer);
  if (!view) return view.error();
  if (view->is_light) {
    show(view->image.data, view->image.channels.size(), exposure);
    display.apply(view->image);
  }
  return std::move(view->image);
}

Result<Image> display_picture(const Image& normalised, const DisplayTransform& display,
                              float exposure, bool transparent) {
  Result<Image> image = straight_beauty(normalised, transparent);
  if (!image) return image;
  show(image->data, image->channels.size(), exposure);
  display.apply(*image);
  return image;
}

Status write_output(const OutputDesc& output, const Image& normalised, const std::string& path,
                    const ImageMetadata& metadata, const DisplayTransform* display) {
  const Result<PictureFormat> format = picture_format(path);
  if (!format) return format.error();
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{fmt::format("cannot make the folder {}: {}", folder.string(), error.message())};
  }
  return write_encoded(*format, output, normalised, path, metadata, display);
}

}  // namespace hyades::core
