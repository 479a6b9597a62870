#include "core/lights/environment_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/elementary.h"

namespace hyades::core {

EnvironmentMap::EnvironmentMap(std::shared_ptr<const Image> image, SkyDensity density)
    : picture_(std::move(image)), width_(picture_.width()), height_(picture_.height()) {
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
  measure(density);
}

/// The mean of a bilinear cell is that of its corners.
Rgb EnvironmentMap::integrate() const {
  Vec3d integral(0.0);
  Vec3d upper(0.0);
  Vec3d lower(0.0);
  for (int row = 0; row <= height_; ++row) {
    upper = lower;
    if (row < height_) {
      lower = Vec3d(0.0);
      for (int x = 0; x < width_; ++x) lower += Vec3d(picture_.at(x, row));
    }
    if (row == 0) upper = lower;
    integral += 0.5 * (upper + lower) * cell_angle(row);
  }
  return Rgb(integral);
}

void EnvironmentMap::measure(SkyDensity density) {
  integral_ = integrate();
  sampled_ = luminance(integral_);
  // A little above the mean, so that rounding leaves nothing of an even picture.
  if (density == SkyDensity::excess) floor_ = sampled_ * (1.0001F / (4.0F * kPi));
  const auto columns = static_cast<size_t>(width_);
  std::vector<float> upper(columns + 1);
  std::vector<float> lower(columns + 1);
  const auto read_row = [&](int y, std::vector<float>& luminances) {
    for (size_t x = 0; x < columns; ++x) {
      luminances[x] = excess(picture_.at(static_cast<int>(x), y));
    }
    luminances[columns] = luminances[0];
  };
  read_row(0, lower);

  std::vector<float> weights;
  weights.reserve(columns * static_cast<size_t>(height_ + 1));
  double sum = 0.0;
  for (int row = 0; row <= height_; ++row) {
    std::swap(upper, lower);
    read_row(std::min(row, height_ - 1), lower);
    if (row == 0) read_row(0, upper);
    const double angle = cell_angle(row);
    for (size_t x = 0; x < columns; ++x) {
      const float mean = 0.25F * (upper[x] + upper[x + 1] + lower[x] + lower[x + 1]);
      weights.push_back(static_cast<float>(double{mean} * angle));
      sum += double{weights.back()};
    }
  }
  if (density == SkyDensity::excess) sampled_ = static_cast<float>(sum);
  cells_ =
      Distribution2D(weights, static_cast<uint32_t>(width_), static_cast<uint32_t>(height_ + 1));
}

float EnvironmentMap::excess(const Rgb& value) const {
  return std::max(luminance(value) - floor_, 0.0F);
}

/// What directions within `cell` are chosen in proportion to.
BilinearCell EnvironmentMap::sampled(const BilinearCell& cell) const {
  if (!(floor_ > 0.0F)) return cell;
  return {Rgb(excess(cell.top_left)), Rgb(excess(cell.top_right)), Rgb(excess(cell.bottom_left)),
          Rgb(excess(cell.bottom_right))};
}

double EnvironmentMap::cell_angle(int row) const {
  const auto r = static_cast<size_t>(row);
  return 2.0 * elementary::kPiD / width_ * (cosines_[r] - cosines_[r + 1]);
}

Rgb EnvironmentMap::look_up(const Vec3& direction, float turn) const {
  const Place place = locate(direction, turn);
  return cell(place.column, place.row).at({place.across, place.down});
}

EnvironmentMap::View EnvironmentMap::view(const Vec3& direction, float turn) const {
  const Place place = locate(direction, turn);
  const BilinearCell c = cell(place.column, place.row);
  View view;
  view.radiance = c.at({place.across, place.down});
  const BilinearCell chosen = sampled(c);
  const float mean = chosen.mean();
  if (!(mean > 0.0F)) return view;
  const float here = luminance(chosen.at({place.across, place.lower}));
  const Vec2 middle((static_cast<float>(place.column) + 0.5F) / static_cast<float>(width_),
                    (static_cast<float>(place.row) + 0.5F) / static_cast<float>(height_ + 1));
  const double cells = static_cast<double>(width_) * (height_ + 1);
  view.pdf = static_cast<float>(double{cells_.pdf(middle)} * double{here / mean} /
                                (cells * cell_angle(place.row)));
  return view;
}

Vec3 EnvironmentMap::sample(const Vec2& u, float turn) const {
  const Distribution2D::Point chosen = cells_.sample(u);
  const auto column = static_cast<int>(chosen.x);
  const auto row = static_cast<int>(chosen.y);
  const float across_u =
      std::max(chosen.at.x * static_cast<float>(width_) - static_cast<float>(column), 0.0F);
  const float down_u =
      std::max(chosen.at.y * static_cast<float>(height_ + 1) - static_cast<float>(row), 0.0F);
  const Vec2 within = sampled(cell(column, row)).sample({across_u, down_u});

  const auto r = static_cast<size_t>(row);
  const double cosine =
      cosines_[r] + static_cast<double>(within.y) * (cosines_[r + 1] - cosines_[r]);
  const double sine = std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0));
  const float turns =
      (static_cast<float>(column) + 0.5F + within.x) / static_cast<float>(width_) - 0.5F - turn;
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

BilinearCell EnvironmentMap::cell(int column, int row) const {
  const int right = column + 1 < width_ ? column + 1 : 0;
  const int top = std::max(row - 1, 0);
  const int bottom = std::min(row, height_ - 1);
  return {picture_.at(column, top), picture_.at(right, top), picture_.at(column, bottom),
          picture_.at(right, bottom)};
}

}  // namespace hyades::core
