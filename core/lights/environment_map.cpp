#include "core/lights/environment_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.h"

namespace hyades::core {

namespace {

constexpr float kLargest = 1e15F;  ///< its square must be finite

/// A place in [0, 1] with density in proportion to a at 0, b at 1, linear in between: the root of
/// the quadratic distribution function in the form that does not cancel.
float sample_linear(float u, float a, float b) {
  const float divisor = a + std::sqrt((1.0F - u) * a * a + u * b * b);
  return divisor > 0.0F ? std::min(u * (a + b) / divisor, 1.0F) : u;
}

float mix(float a, float b, float t) { return (1.0F - t) * a + t * b; }

}  // namespace

EnvironmentMap::EnvironmentMap(std::shared_ptr<const Image> image)
    : image_(std::move(image)), width_(image_->width), height_(image_->height) {
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const int found = image_->find_channel(names[c]);
    channels_[c] = std::max(found >= 0 ? found : image_->find_channel("Y"), 0);
  }

  // 1 - cos = 2 sin^2(theta / 2) keeps its figures near the upper pole; the lower one mirrors it.
  const int rows = height_ + 1;
  cosines_.resize(static_cast<size_t>(rows) + 1);
  for (int edge = 0; edge <= rows; ++edge) {
    const int mirrored = std::min(edge, rows - edge);
    const float v =
        mirrored == 0 ? 0.0F : (static_cast<float>(mirrored) - 0.5F) / static_cast<float>(height_);
    const double half = static_cast<double>(sin(0.5F * kPi * v));
    const double cosine = 2 * edge == rows ? 0.0 : 1.0 - 2.0 * half * half;
    cosines_[static_cast<size_t>(edge)] = edge == mirrored ? cosine : -cosine;
  }

  std::vector<float> weights;
  weights.reserve(static_cast<size_t>(rows) * static_cast<size_t>(width_));
  Vec3d integral(0.0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < width_; ++column) {
      // The middle of a bilinear cell is its mean.
      const Rgb mean = blend(column, row, 0.5F, 0.5F);
      weights.push_back(static_cast<float>(double{luminance(mean)} * cell_angle(row)));
      integral += Vec3d(mean) * cell_angle(row);
    }
  }
  cells_ = Distribution2D(weights, static_cast<uint32_t>(width_), static_cast<uint32_t>(rows));
  integral_ = Rgb(integral);
}

double EnvironmentMap::cell_angle(int row) const {
  const auto r = static_cast<size_t>(row);
  return 2.0 * elementary::kPiD / width_ * (cosines_[r] - cosines_[r + 1]);
}

Rgb EnvironmentMap::look_up(const Vec3& direction, float turn) const {
  const Place place = locate(direction, turn);
  return blend(place.column, place.row, place.across, place.down);
}

float EnvironmentMap::density(const Place& place, float cell_pdf) const {
  const Corners c = corners_of(place.column, place.row);
  const float mean = c.mean();
  if (!(mean > 0.0F)) return 0.0F;
  const float left = mix(c.top_left, c.bottom_left, place.lower);
  const float right = mix(c.top_right, c.bottom_right, place.lower);
  const float here = mix(left, right, place.across);
  const double cells = static_cast<double>(width_) * (height_ + 1);
  return static_cast<float>(double{cell_pdf} * double{here / mean} /
                            (cells * cell_angle(place.row)));
}

float EnvironmentMap::pdf(const Vec3& direction, float turn) const {
  const Place place = locate(direction, turn);
  const Vec2 cell((static_cast<float>(place.column) + 0.5F) / static_cast<float>(width_),
                  (static_cast<float>(place.row) + 0.5F) / static_cast<float>(height_ + 1));
  return density(place, cells_.pdf(cell));
}

Vec3 EnvironmentMap::sample(const Vec2& u, float turn) const {
  const Distribution2D::Point cell = cells_.sample(u);
  const auto column = static_cast<int>(cell.x);
  const auto row = static_cast<int>(cell.y);
  const float across_u =
      std::max(cell.at.x * static_cast<float>(width_) - static_cast<float>(column), 0.0F);
  const float down_u =
      std::max(cell.at.y * static_cast<float>(height_ + 1) - static_cast<float>(row), 0.0F);
  // Bilinear density: first the height (its marginal is linear), then the column given that.
  const Corners c = corners_of(column, row);
  const float lower =
      sample_linear(down_u, c.top_left + c.top_right, c.bottom_left + c.bottom_right);
  const float across = sample_linear(across_u, mix(c.top_left, c.bottom_left, lower),
                                     mix(c.top_right, c.bottom_right, lower));

  const auto r = static_cast<size_t>(row);
  const double cosine = cosines_[r] + static_cast<double>(lower) * (cosines_[r + 1] - cosines_[r]);
  const double sine = std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0));
  const float turns =
      (static_cast<float>(column) + 0.5F + across) / static_cast<float>(width_) - 0.5F - turn;
  const SinCos azimuth = sin_cos(2.0F * kPi * turns);
  return glm::normalize(Vec3(Vec3d(sine * static_cast<double>(azimuth.cos), cosine,
                                   sine * static_cast<double>(azimuth.sin))));
}

EnvironmentMap::Place EnvironmentMap::locate(const Vec3& direction, float turn) const {
  Place place;
  float u = atan2(direction.z, direction.x) / (2.0F * kPi) + 0.5F + turn;
  u -= std::floor(u);
  const float x = u * static_cast<float>(width_) - 0.5F;
  const float column = std::floor(x);
  place.across = x - column;
  place.column = static_cast<int>(column);
  if (place.column < 0) place.column += width_;
  if (place.column >= width_) place.column -= width_;

  const Vec3d d(direction);
  const double horizontal2 = d.x * d.x + d.z * d.z;
  const double cosine = d.y / std::sqrt(horizontal2 + d.y * d.y);
  const float v = atan2(static_cast<float>(std::sqrt(horizontal2)), direction.y) / kPi;
  const float y = v * static_cast<float>(height_) + 0.5F;
  int row = std::clamp(static_cast<int>(y), 0, height_);
  // At an edge both measures of the same place must agree on the row; the cosine decides.
  if (row < height_ && cosine < cosines_[static_cast<size_t>(row) + 1]) ++row;
  if (row > 0 && cosine > cosines_[static_cast<size_t>(row)]) --row;
  place.row = row;
  place.down = std::clamp(y - static_cast<float>(row), 0.0F, 1.0F);
  const double top = cosines_[static_cast<size_t>(row)];
  const double bottom = cosines_[static_cast<size_t>(row) + 1];
  place.lower = std::clamp(static_cast<float>((top - cosine) / (top - bottom)), 0.0F, 1.0F);
  return place;
}

Rgb EnvironmentMap::pixel(int x, int y) const {
  Rgb value;
  for (int c = 0; c < 3; ++c) {
    const float raw = image_->at(x, y, channels_[c]);
    value[c] = raw > 0.0F ? std::min(raw, kLargest) : 0.0F;  // NaN is not > 0
  }
  return value;
}

Rgb EnvironmentMap::blend(int column, int row, float across, float down) const {
  const int right = column + 1 < width_ ? column + 1 : 0;
  const int top = std::max(row - 1, 0);
  const int bottom = std::min(row, height_ - 1);
  const Rgb upper = (1.0F - across) * pixel(column, top) + across * pixel(right, top);
  const Rgb lower = (1.0F - across) * pixel(column, bottom) + across * pixel(right, bottom);
  return (1.0F - down) * upper + down * lower;
}

EnvironmentMap::Corners EnvironmentMap::corners_of(int column, int row) const {
  const int right = column + 1 < width_ ? column + 1 : 0;
  const int top = std::max(row - 1, 0);
  const int bottom = std::min(row, height_ - 1);
  return {luminance(pixel(column, top)), luminance(pixel(right, top)),
          luminance(pixel(column, bottom)), luminance(pixel(right, bottom))};
}

}  // namespace hyades::core
