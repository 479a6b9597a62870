#include "coordinator/web/picture_encoding.h"

#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/base/color.h"
#include "core/image/write_image.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

std::string layer_of(const std::string& channel) {
  if (channel == "R" || channel == "G" || channel == "B" || channel == "Y") return "beauty";
  if (channel == "A") return "alpha";
  return channel.substr(0, channel.find('.'));
}

/// The part of [a, b) that lies in [x, x + 1).
double overlap(double a, double b, int x) {
  return std::min(b, x + 1.0) - std::max(a, static_cast<double>(x));
}

/// A part of a picture that becomes one pixel: columns [x0, x1), rows [y0, y1).
struct Patch {
  double x0;
  double x1;
  double y0;
  double y1;

  /// Calls `visit(x, y, area)` for each pixel that lies in it, with the area that does.
  template <class Visit>
  void each(const core::Image& image, const Visit& visit) const {
    for (int y = static_cast<int>(y0); y < std::min<double>(y1, image.height); ++y) {
      for (int x = static_cast<int>(x0); x < std::min<double>(x1, image.width); ++x) {
        visit(x, y, overlap(x0, x1, x) * overlap(y0, y1, y));
      }
    }
  }
};

size_t pixel_of(const core::Image& image, int x, int y) {
  return static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x);
}

/// The mean of a channel over a part of the picture.
float mean_of(const core::Image& image, const Patch& patch, int channel,
              const SampledMask& sampled) {
  double sum = 0;
  double weight = 0;
  float other = 0;
  patch.each(image, [&](int x, int y, double area) {
    if (!sampled.empty() && sampled[pixel_of(image, x, y)] == 0) return;
    const float value = image.at(x, y, channel);
    if (!std::isfinite(value)) {
      other = value;
      return;
    }
    sum += area * static_cast<double>(value);
    weight += area;
  });
  return weight > 0 ? static_cast<float>(sum / weight) : other;
}

/// How much of a part of the picture is there: what has any samples is not 0.
uint8_t share_of(const core::Image& image, const Patch& patch, const SampledMask& sampled) {
  double there = 0;
  double all = 0;
  patch.each(image, [&](int x, int y, double area) {
    there += area * sampled[pixel_of(image, x, y)];
    all += area;
  });
  if (there <= 0) return 0;
  return static_cast<uint8_t>(std::clamp(std::lround(there / all), 1L, 255L));
}

}  // namespace

std::vector<std::string> layers_of(const core::Image& image) {
  std::vector<std::string> layers;
  for (const std::string& channel : image.channels) {
    const std::string layer = layer_of(channel);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

core::Result<core::Image> take_layer(const core::Image& image, const std::string& layer) {
  std::vector<int> taken;
  std::vector<std::string> names;
  for (int c = 0; c < image.channel_count(); ++c) {
    const std::string& channel = image.channels[static_cast<size_t>(c)];
    if (layer_of(channel) != layer) continue;
    taken.push_back(c);
    names.push_back(channel);
  }
  if (taken.empty()) {
    std::string all;
    for (const std::string& one : layers_of(image)) all += (all.empty() ? "" : ", ") + one;
    return core::Error{fmt::format("there is no layer '{}': expected one of {}", layer, all)};
  }
  core::Image one = core::make_image(image.width, image.height, std::move(names));
  const size_t stride = image.channels.size();
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < taken.size(); ++c) {
      one.data[i * taken.size() + c] = image.data[i * stride + static_cast<size_t>(taken[c])];
    }
  }
  return one;
}

SampledMask sampled_pixels(const core::Film& film) {
  const core::PixelRect& window = film.window();
  const auto width = static_cast<size_t>(window.width());
  SampledMask mask(width * static_cast<size_t>(window.height()), 0);
  for (const core::CoverageBox& box : film.coverage().boxes()) {
    const core::PixelRect tile = core::intersection(box.tile, window);
    if (tile.empty() || box.batches.count == 0) continue;
    for (int32_t y = tile.y0; y < tile.y1; ++y) {
      const size_t row = static_cast<size_t>(y - window.y0) * width;
      std::fill_n(mask.begin() +
                      static_cast<std::ptrdiff_t>(row + static_cast<size_t>(tile.x0 - window.x0)),
                  tile.width(), uint8_t{255});
    }
  }
  const bool all = std::all_of(mask.begin(), mask.end(), [](uint8_t one) { return one == 255; });
  return all ? SampledMask() : mask;
}

core::Image shrink(const core::Image& image, int width, SampledMask& sampled) {
  if (width >= image.width || image.width == 0) return image;
  const double scale = static_cast<double>(image.width) / width;
  const int height = std::max(1, static_cast<int>(std::lround(image.height / scale)));
  const double scale_y = static_cast<double>(image.height) / height;
  core::Image small = core::make_image(width, height, image.channels);
  SampledMask mask;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Patch patch{x * scale, (x + 1) * scale, y * scale_y, (y + 1) * scale_y};
      for (int c = 0; c < image.channel_count(); ++c) {
        small.at(x, y, c) = mean_of(image, patch, c, sampled);
      }
      if (!sampled.empty()) mask.push_back(share_of(image, patch, sampled));
    }
  }
  sampled = std::move(mask);
  return small;
}

core::Result<core::Bytes> display_png(const core::Image& image, core::ToneCurve curve,
                                      float exposure) {
  const int red = std::max(image.find_channel("R"), image.find_channel("Y"));
  const int green = image.find_channel("G") >= 0 ? image.find_channel("G") : red;
  const int blue = image.find_channel("B") >= 0 ? image.find_channel("B") : red;
  if (red < 0) return core::Error{"the picture has no colours"};
  core::Image shown = core::make_image(image.width, image.height, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const core::Rgb display = core::tone_map(
          {image.at(x, y, red), image.at(x, y, green), image.at(x, y, blue)}, curve, exposure);
      for (int c = 0; c < 3; ++c) shown.at(x, y, c) = display[c];
    }
  }
  return core::encode_png(shown);
}

std::string half_planes(const core::Image& image, const HalfFacts& facts) {
  const bool has_mask = facts.mask != nullptr && !facts.mask->empty();
  const farm::Json header = {
      {"width", image.width}, {"height", image.height},         {"channels", image.channels},
      {"layer", facts.layer}, {"layers", facts.layers},         {"samples", facts.samples_done},
      {"exact", facts.exact}, {"full_width", facts.full_width}, {"full_height", facts.full_height},
      {"mask", has_mask}};
  std::string bytes = header.dump() + "\n";
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  const size_t channels = image.channels.size();
  const size_t begin = bytes.size();
  bytes.resize(begin + pixels * channels * 2);
  constexpr float kLargest = 65504.0F;
  for (size_t c = 0; c < channels; ++c) {
    for (size_t i = 0; i < pixels; ++i) {
      float value = image.data[i * channels + c];
      if (std::isfinite(value)) value = std::clamp(value, -kLargest, kLargest);
      const uint16_t bits = Imath::half(value).bits();
      char* to = bytes.data() + begin + (c * pixels + i) * 2;
      to[0] = static_cast<char>(bits & 0xFFU);
      to[1] = static_cast<char>(bits >> 8U);
    }
  }
  if (has_mask) bytes.append(facts.mask->begin(), facts.mask->end());
  return bytes;
}

}  // namespace hyades::coordinator
