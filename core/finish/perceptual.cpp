#include "core/finish/perceptual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace hyades::core {
namespace {

constexpr int kFields = 12;

/// Each pixel's place in CIELAB.
struct LabPicture {
  int width = 0;
  int height = 0;
  std::vector<Vec3> pixels;

  Vec3& at(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

float lab_curve(float t) {
  constexpr float kEdge = 6.0F / 29.0F;
  return t > kEdge * kEdge * kEdge ? std::cbrt(t) : t / (3.0F * kEdge * kEdge) + 4.0F / 29.0F;
}

/// The mean of every `times` x `times` pixels.
Image averaged_down(const Image& image, int times) {
  Image out = make_image(image.width / times, image.height / times, image.channels);
  for (int y = 0; y < out.height * times; ++y) {
    for (int x = 0; x < out.width * times; ++x) {
      for (int c = 0; c < image.channel_count(); ++c)
        out.at(x / times, y / times, c) += image.at(x, y, c) / static_cast<float>(times * times);
    }
  }
  return out;
}

/// How many times `large` is as large as `small`; 0: not a whole number of times.
int times_as_large(const Image& large, const Image& small) {
  if (small.width < 1 || small.height < 1) return 0;
  const int times = large.width / small.width;
  const bool fits = small.width * times == large.width && small.height * times == large.height;
  return fits ? times : 0;
}

/// From linear Rec.709, whose white (D65) is (1, 1, 1).
Vec3 lab_of(const Rgb& color) {
  const Rgb c = glm::clamp(color, Rgb(0.0F), Rgb(1.0F));
  const float x = (0.4124564F * c.x + 0.3575761F * c.y + 0.1804375F * c.z) / 0.95047F;
  const float y = 0.2126729F * c.x + 0.7151522F * c.y + 0.0721750F * c.z;
  const float z = (0.0193339F * c.x + 0.1191920F * c.y + 0.9503041F * c.z) / 1.08883F;
  const float fy = lab_curve(y);
  return {116.0F * fy - 16.0F, 500.0F * (lab_curve(x) - fy), 200.0F * (fy - lab_curve(z))};
}

/// The blur of linear light along one axis.
void blur_rows(LabPicture& picture, float sigma, bool vertical) {
  const int reach = static_cast<int>(std::ceil(3.0F * sigma));
  std::vector<float> weights;
  for (int i = 0; i <= reach; ++i) {
    const float d = static_cast<float>(i) / sigma;
    weights.push_back(std::exp(-0.5F * d * d));
  }
  LabPicture out = picture;
  const int length = vertical ? picture.height : picture.width;
  const int lines = vertical ? picture.width : picture.height;
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < length; ++i) {
      Vec3 sum(0.0F);
      float total = 0.0F;
      for (int k = std::max(-reach, -i); k <= std::min(reach, length - 1 - i); ++k) {
        const float w = weights[static_cast<size_t>(std::abs(k))];
        sum += w * (vertical ? picture.at(line, i + k) : picture.at(i + k, line));
        total += w;
      }
      (vertical ? out.at(line, i) : out.at(i, line)) = sum / total;
    }
  }
  picture = std::move(out);
}

Result<LabPicture> blurred_lab(const Image& image) {
  const int channels[3] = {image.find_channel("R"), image.find_channel("G"),
                           image.find_channel("B")};
  if (std::min({channels[0], channels[1], channels[2]}) < 0)
    return Error{"a picture has no channels R, G, B"};
  LabPicture out{image.width, image.height, {}};
  out.pixels.resize(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = image.at(x, y, channels[c]);
        out.at(x, y)[c] = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
      }
    }
  }
  const float sigma = 0.01F * static_cast<float>(image.width);
  blur_rows(out, sigma, false);
  blur_rows(out, sigma, true);
  for (Vec3& pixel : out.pixels) pixel = lab_of(pixel);
  return out;
}

}  // namespace

Result<PerceptualDifference> perceptual_difference(const Image& a, const Image& b) {
  if (const int times = times_as_large(a, b); times > 1)
    return perceptual_difference(averaged_down(a, times), b);
  if (const int times = times_as_large(b, a); times > 1)
    return perceptual_difference(a, averaged_down(b, times));
  if (a.width != b.width || a.height != b.height) {
    return Error{fmt::format("the pictures have {} x {} and {} x {} pixels, expected the same size",
                             a.width, a.height, b.width, b.height)};
  }
  auto lab_a = blurred_lab(a);
  if (!lab_a) return lab_a.error();
  auto lab_b = blurred_lab(b);
  if (!lab_b) return lab_b.error();
  PerceptualDifference out;
  for (int row = 0; row < kFields; ++row) {
    for (int column = 0; column < kFields; ++column) {
      const int x0 = a.width * column / kFields;
      const int x1 = a.width * (column + 1) / kFields;
      const int y0 = a.height * row / kFields;
      const int y1 = a.height * (row + 1) / kFields;
      double sum = 0.0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) sum += double{glm::length(lab_a->at(x, y) - lab_b->at(x, y))};
      }
      out.mean += sum;
      const int pixels = (x1 - x0) * (y1 - y0);
      if (pixels == 0 || sum / pixels <= out.largest) continue;
      out.largest = sum / pixels;
      out.x = x0;
      out.y = y0;
    }
  }
  out.mean /= static_cast<double>(a.width) * static_cast<double>(a.height);
  return out;
}

}  // namespace hyades::core
