#include "coordinator/web/preview.h"

#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <cstring>

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

/// The mean of a channel over [x0, x1) x [y0, y1) of the picture.
float mean_of(const core::Image& image, double x0, double x1, double y0, double y1, int channel) {
  double sum = 0;
  double weight = 0;
  float other = 0;
  for (int y = static_cast<int>(y0); y < std::min<double>(y1, image.height); ++y) {
    for (int x = static_cast<int>(x0); x < std::min<double>(x1, image.width); ++x) {
      const float value = image.at(x, y, channel);
      if (!std::isfinite(value)) {
        other = value;
        continue;
      }
      const double area = overlap(x0, x1, x) * overlap(y0, y1, y);
      sum += area * static_cast<double>(value);
      weight += area;
    }
  }
  return weight > 0 ? static_cast<float>(sum / weight) : other;
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

core::Image shrink(const core::Image& image, int width) {
  if (width >= image.width || image.width == 0) return image;
  const double scale = static_cast<double>(image.width) / width;
  const int height = std::max(1, static_cast<int>(std::lround(image.height / scale)));
  const double scale_y = static_cast<double>(image.height) / height;
  core::Image small = core::make_image(width, height, image.channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < image.channel_count(); ++c) {
        small.at(x, y, c) =
            mean_of(image, x * scale, (x + 1) * scale, y * scale_y, (y + 1) * scale_y, c);
      }
    }
  }
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
  const farm::Json header = {{"width", image.width},       {"height", image.height},
                             {"channels", image.channels}, {"layer", facts.layer},
                             {"layers", facts.layers},     {"samples", facts.samples_done},
                             {"exact", facts.exact}};
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
  return bytes;
}

}  // namespace hyades::coordinator
