#include "core/media/sphere_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"
#include "core/image/rgb_channels.h"

namespace hyades::core {
namespace {

float clean(float value) { return value > 0.0F ? std::min(value, 1e15F) : 0.0F; }

}  // namespace

SphereImage::SphereImage(const Image& image, float turn)
    : width_(image.width),
      height_(image.height),
      turn_(turn),
      tiles_across_((image.width + kTile - 1) / kTile) {
  const auto channels = rgb_channels(image).value_or(std::array{0, 0, 0});
  const int tiles_down = (height_ + kTile - 1) / kTile;
  tiles_.assign(static_cast<size_t>(tiles_across_) * static_cast<size_t>(tiles_down), 0.0F);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      Rgb color = rgb_at(image, channels, x, y);
      for (int c = 0; c < 3; ++c) color[c] = clean(color[c]);
      pixels_.push_back(color);
      float& tile = tiles_[static_cast<size_t>(y / kTile * tiles_across_ + x / kTile)];
      tile = std::max(tile, luminance(color));
    }
  }
}

float SphereImage::column_of(const Vec3& direction) const {
  const float u = atan2(direction.z, direction.x) / (2.0F * kPi) + 0.5F + turn_;
  return (u - std::floor(u)) * static_cast<float>(width_);
}

float SphereImage::row_of(const Vec3& direction) const {
  const float horizontal = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  return atan2(horizontal, direction.y) / kPi * static_cast<float>(height_);
}

Rgb SphereImage::at(const Vec3& direction) const {
  const float x = column_of(direction) - 0.5F;
  const float y = std::clamp(row_of(direction) - 0.5F, 0.0F, static_cast<float>(height_ - 1));
  const float column = std::floor(x);
  const int left = (static_cast<int>(column) + width_) % width_;
  const int right = (left + 1) % width_;
  const int top = std::min(static_cast<int>(y), height_ - 1);
  const int bottom = std::min(top + 1, height_ - 1);
  const float across = x - column;
  return glm::mix(glm::mix(pixel(left, top), pixel(right, top), across),
                  glm::mix(pixel(left, bottom), pixel(right, bottom), across),
                  y - static_cast<float>(top));
}

float SphereImage::greatest_luminance(const Vec3& direction, float angle) const {
  const float row = row_of(direction);
  const float theta = row / static_cast<float>(height_) * kPi;
  // Two pixels more: those that bilinear look-up mixes in, and rounding.
  const float rows = angle / kPi * static_cast<float>(height_) + 2.0F;
  const int first = std::max(static_cast<int>(row - rows), 0) / kTile;
  const int last = std::min(static_cast<int>(row + rows), height_ - 1) / kTile;
  // Of the meridians that touch the cone; all where it holds a pole.
  float columns = static_cast<float>(width_);
  if (angle < theta && angle < kPi - theta && angle < 0.5F * kPi) {
    columns =
        asin(std::min(sin(angle) / sin(theta), 1.0F)) / (2.0F * kPi) * static_cast<float>(width_) +
        2.0F;
  }
  const auto begin = static_cast<int>(std::floor(column_of(direction) - columns));
  const int count = std::min(static_cast<int>(2.0F * columns) + 2, width_);
  float greatest = 0.0F;
  for (int tile = first; tile <= last; ++tile) {
    for (int i = 0; i < count + kTile; i += kTile) {
      const int x = ((begin + std::min(i, count)) % width_ + width_) % width_;
      greatest = std::max(greatest, tiles_[static_cast<size_t>(tile * tiles_across_ + x / kTile)]);
    }
  }
  return greatest;
}

}  // namespace hyades::core
