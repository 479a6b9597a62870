#include "core/lights/gobo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace hyades::core {
namespace {

/// Where cell `i` of `pixels` + 1 begins, in pixels from the border.
float begin_of(int i, int pixels) {
  return std::clamp(static_cast<float>(i) - 0.5F, 0.0F, static_cast<float>(pixels));
}

float width_of(int i, int pixels) { return begin_of(i + 1, pixels) - begin_of(i, pixels); }

/// The cell at `x` pixels from the border and how far in it.
int cell_at(float x, int pixels, float& within) {
  const int i = std::clamp(static_cast<int>(x + 0.5F), 0, pixels);
  within = std::clamp((x - begin_of(i, pixels)) / width_of(i, pixels), 0.0F, 1.0F);
  return i;
}

}  // namespace

Gobo::Gobo(std::shared_ptr<const Image> image) : picture_(std::move(image)) {
  const Vec2 size(static_cast<float>(picture_.width()), static_cast<float>(picture_.height()));
  half_size_ = size / std::min(size.x, size.y);
  const int columns = picture_.width() + 1;
  const int rows = picture_.height() + 1;
  std::vector<float> weights;
  weights.reserve(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const float height = width_of(row, picture_.height());
    for (int column = 0; column < columns; ++column) {
      weights.push_back(cell(column, row).mean() * height * width_of(column, picture_.width()));
    }
  }
  cells_ = Distribution2D(weights, static_cast<uint32_t>(columns), static_cast<uint32_t>(rows));
  look_over();
}

void Gobo::look_over() {
  // As many looks at each pixel, or more, as there are cells.
  const int across = (kOverview + picture_.width() - 1) / picture_.width() * picture_.width();
  const int down = (kOverview + picture_.height() - 1) / picture_.height() * picture_.height();
  std::vector<Vec3d> sums(size_t{kOverview} * kOverview, Vec3d(0.0));
  std::vector<int> counts(sums.size(), 0);
  for (int j = 0; j < down; ++j) {
    const float v = (static_cast<float>(j) + 0.5F) / static_cast<float>(down);
    for (int i = 0; i < across; ++i) {
      const float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(across);
      const Place at = locate({u, v});
      const auto seen = static_cast<size_t>(static_cast<int>(v * kOverview) * kOverview +
                                            static_cast<int>(u * kOverview));
      sums[seen] += Vec3d(cell(at.column, at.row).at(at.within));
      ++counts[seen];
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    overview_.push_back(Rgb(sums[i] / static_cast<double>(counts[i])));
  }
}

Gobo::View Gobo::view(const Vec2& place) const {
  const Place at = locate(place);
  const BilinearCell c = cell(at.column, at.row);
  View view;
  view.value = c.at(at.within);
  const float mean = c.mean();
  if (!(mean > 0.0F)) return view;
  const int columns = picture_.width() + 1;
  const int rows = picture_.height() + 1;
  const Vec2 middle((static_cast<float>(at.column) + 0.5F) / static_cast<float>(columns),
                    (static_cast<float>(at.row) + 0.5F) / static_cast<float>(rows));
  // The distribution has cells of one size; pixels are the unit of theirs here.
  const double chosen = static_cast<double>(cells_.pdf(middle)) / columns / rows;
  const double area = static_cast<double>(width_of(at.column, picture_.width())) /
                      picture_.width() * static_cast<double>(width_of(at.row, picture_.height())) /
                      picture_.height();
  view.pdf = static_cast<float>(chosen / area * static_cast<double>(luminance(view.value) / mean));
  return view;
}

Vec2 Gobo::sample(const Vec2& u) const {
  const Distribution2D::Point chosen = cells_.sample(u);
  const auto column = static_cast<int>(chosen.x);
  const auto row = static_cast<int>(chosen.y);
  const Vec2 left(
      chosen.at.x * static_cast<float>(picture_.width() + 1) - static_cast<float>(column),
      chosen.at.y * static_cast<float>(picture_.height() + 1) - static_cast<float>(row));
  const Vec2 within = cell(column, row).sample(glm::clamp(left, 0.0F, 1.0F));
  return {(begin_of(column, picture_.width()) + within.x * width_of(column, picture_.width())) /
              static_cast<float>(picture_.width()),
          (begin_of(row, picture_.height()) + within.y * width_of(row, picture_.height())) /
              static_cast<float>(picture_.height())};
}

Gobo::Place Gobo::locate(const Vec2& place) const {
  Place at;
  at.column =
      cell_at(place.x * static_cast<float>(picture_.width()), picture_.width(), at.within.x);
  at.row = cell_at(place.y * static_cast<float>(picture_.height()), picture_.height(), at.within.y);
  return at;
}

BilinearCell Gobo::cell(int column, int row) const {
  const int left = std::max(column - 1, 0);
  const int right = std::min(column, picture_.width() - 1);
  const int top = std::max(row - 1, 0);
  const int bottom = std::min(row, picture_.height() - 1);
  return {picture_.at(left, top), picture_.at(right, top), picture_.at(left, bottom),
          picture_.at(right, bottom)};
}

}  // namespace hyades::core
