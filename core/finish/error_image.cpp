#include <algorithm>
#include <cmath>
#include <vector>

#include "core/finish/compare.h"
#include "core/finish/compare_channels.h"

namespace hyades::core {
namespace {

/// Black, red, yellow, white as t goes from 0 to 1.
Rgb heat(double t) {
  const auto ramp = [t](double from) {
    return static_cast<float>(std::clamp(3.0 * t - from, 0.0, 1.0));
  };
  return {ramp(0.0), ramp(1.0), ramp(2.0)};
}

}  // namespace

Result<Image> error_image(const Image& a, const Image& b, const CompareOptions& options) {
  const Result<std::vector<CommonChannel>> channels = common_channels(a, b, options);
  if (!channels) return channels.error();
  Image image = make_image(a.width, a.height, {"R", "G", "B"});
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      Rgb color(0.0F, 0.0F, 1.0F);
      if (is_finite(a, b, *channels, x, y)) {
        double sum = 0.0;
        for (const CommonChannel& channel : *channels) {
          const double reference = b.at(x, y, channel.b);
          const double difference = double{a.at(x, y, channel.a)} - reference;
          sum += difference * difference / (reference * reference + options.epsilon);
        }
        const double error = std::sqrt(sum / static_cast<double>(channels->size()));
        // Three decades, 0.001 to 1.
        color = heat(error > 0.0 ? std::log10(error) / 3.0 + 1.0 : 0.0);
      }
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = color[c];
    }
  }
  return image;
}

}  // namespace hyades::core
