#include "core/base/distribution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hyades::core {
namespace {

constexpr uint32_t kSteps = 1U << 24;

double clean(float weight) {
  return weight > 0.0F && std::isfinite(weight) ? static_cast<double>(weight) : 0.0;
}

/// Fills `cumulative` (one longer than `weights`) and returns the sum of the weights. Each positive
/// weight gets one step, the rest of the steps are shared in proportion.
template <class Weights>
double accumulate(const Weights& weights, std::span<uint32_t> cumulative) {
  const size_t n = cumulative.size() - 1;
  double total = 0.0;
  uint32_t positive = 0;
  for (size_t i = 0; i < n; ++i) {
    total += weights(i);
    positive += weights(i) > 0.0 ? 1 : 0;
  }
  cumulative[0] = 0;
  const uint32_t reserve = positive < kSteps / 2 ? 1 : 0;
  const double scale = total > 0.0 ? static_cast<double>(kSteps - reserve * positive) / total : 0.0;
  double sum = 0.0;
  uint32_t reserved = 0;
  uint32_t left = positive;
  for (size_t i = 0; i < n; ++i) {
    const double w = weights(i);
    if (!(w > 0.0)) {
      cumulative[i + 1] = cumulative[i];
      continue;
    }
    sum += w;
    reserved += reserve;
    const bool last = --left == 0;
    cumulative[i + 1] = last ? kSteps
                             : std::min(reserved + static_cast<uint32_t>(sum * scale + 0.5),
                                        kSteps - reserve * left);
  }
  return total;
}

/// The entry i with cumulative[i] <= u 2^24 < cumulative[i + 1].
Distribution1D::Choice choose(std::span<const uint32_t> cumulative, float u) {
  const float scaled = std::clamp(u, 0.0F, 0x1.fffffep-1F) * 0x1p24F;
  const auto step = static_cast<uint32_t>(scaled);
  // Binary search for the last entry that starts at or before `step`, without branches: which half
  // is right cannot be predicted.
  uint32_t index = 0;
  for (auto left = static_cast<uint32_t>(cumulative.size() - 1); left > 1;) {
    const uint32_t half = left / 2;
    index += half * static_cast<uint32_t>(cumulative[index + half] <= step);
    left -= half;
  }
  const uint32_t low = cumulative[index];
  const auto width = static_cast<float>(cumulative[index + 1] - low);
  const float offset = static_cast<float>(step - low) + (scaled - static_cast<float>(step));
  return {index, width * 0x1p-24F, width > 0.0F ? std::min(offset / width, 0x1.fffffep-1F) : 0.0F};
}

float invert_choice(std::span<const uint32_t> cumulative, uint32_t index, float remainder) {
  const uint32_t low = cumulative[index];
  const auto width = static_cast<float>(cumulative[index + 1] - low);
  return (static_cast<float>(low) + width * remainder) * 0x1p-24F;
}

/// Cell of coordinate t in [0, 1) among n cells and the place in it.
uint32_t cell_of(float t, uint32_t n, float& place) {
  const float scaled = t * static_cast<float>(n);
  const uint32_t cell = std::min(static_cast<uint32_t>(std::max(scaled, 0.0F)), n - 1);
  place = std::clamp(scaled - static_cast<float>(cell), 0.0F, 0x1.fffffep-1F);
  return cell;
}

/// The coordinate of place u in cell `index` of n, such that cell_of() finds that cell again
/// whatever the roundings.
float coordinate_in(uint32_t index, float u, uint32_t n) {
  const auto count = static_cast<float>(n);
  float t = (static_cast<float>(index) + u) / count;
  while (t * count < static_cast<float>(index)) t = std::nextafter(t, 1.0F);
  while (t > 0.0F && (t * count >= static_cast<float>(index + 1) || t >= 1.0F)) {
    t = std::nextafter(t, 0.0F);
  }
  return t;
}

}  // namespace

Distribution1D::Distribution1D(std::span<const float> weights)
    : size_(static_cast<uint32_t>(weights.size())), cumulative_(weights.size() + 1) {
  total_ = accumulate([&](size_t i) { return clean(weights[i]); }, cumulative_);
}

Distribution1D::Choice Distribution1D::sample(float u) const {
  if (empty()) return {};
  return choose(cumulative_, u);
}

float Distribution1D::invert(uint32_t index, float remainder) const {
  return invert_choice(cumulative_, index, remainder);
}

Distribution2D::Distribution2D(std::span<const float> weights, uint32_t width, uint32_t height)
    : width_(width), height_(height), cells_(size_t{height} * (size_t{width} + 1)) {
  std::vector<double> sums(height);
  for (uint32_t y = 0; y < height; ++y) {
    const std::span<const float> values = weights.subspan(size_t{y} * width, width);
    sums[y] = accumulate([&](size_t x) { return clean(values[x]); },
                         {cells_.data() + size_t{y} * (width + 1), width + size_t{1}});
  }
  rows_.size_ = height;
  rows_.cumulative_.resize(size_t{height} + 1);
  rows_.total_ = accumulate([&](size_t y) { return sums[y]; }, rows_.cumulative_);
}

Distribution2D::Point Distribution2D::sample(const Vec2& u) const {
  if (empty()) return {};
  const auto chosen_row = rows_.sample(u.y);
  const auto chosen = choose(row(chosen_row.index), u.x);
  const auto w = static_cast<float>(width_);
  const auto h = static_cast<float>(height_);
  return {{coordinate_in(chosen.index, chosen.u, width_),
           coordinate_in(chosen_row.index, chosen_row.u, height_)},
          chosen.probability * w * (chosen_row.probability * h),
          chosen.index,
          chosen_row.index};
}

float Distribution2D::pdf(const Vec2& at) const {
  if (empty() || !(at.x >= 0.0F && at.x < 1.0F && at.y >= 0.0F && at.y < 1.0F)) return 0.0F;
  float place = 0.0F;
  const uint32_t x = cell_of(at.x, width_, place);
  const uint32_t y = cell_of(at.y, height_, place);
  const std::span<const uint32_t> cells = row(y);
  return static_cast<float>(cells[x + 1] - cells[x]) * 0x1p-24F * static_cast<float>(width_) *
         (rows_.probability(y) * static_cast<float>(height_));
}

Vec2 Distribution2D::invert(const Vec2& at) const {
  float place_x = 0.0F;
  float place_y = 0.0F;
  const uint32_t x = cell_of(at.x, width_, place_x);
  const uint32_t y = cell_of(at.y, height_, place_y);
  return {invert_choice(row(y), x, place_x), rows_.invert(y, place_y)};
}

double Distribution2D::mean() const {
  return empty() ? 0.0 : rows_.total() / (static_cast<double>(width_) * height_);
}

}  // namespace hyades::core
