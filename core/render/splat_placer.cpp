#include "core/render/splat_placer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hyades::core {
namespace {

constexpr int kMostPixels = 40;  ///< in the reach of the widest filter (16 pixels), along one axis

}  // namespace

bool counts(const PixelSplat& splat) {
  return std::all_of(splat.value.begin(), splat.value.end(),
                     [](float v) { return std::fabs(v) <= kMaxSplat; });
}

bool add_splat(const PixelSplat& splat, std::vector<PixelSplat>& into) {
  if (!counts(splat)) return false;
  float largest = 0.0F;
  for (const float v : splat.value) largest = std::max(largest, std::fabs(v));
  if (largest == 0.0F) return true;
  const float parts = std::max(std::ceil(largest / kMaxDeposit), 1.0F);
  PixelSplat part = splat;
  for (float& v : part.value) v /= parts;
  into.insert(into.end(), static_cast<size_t>(parts), part);
  return true;
}

void BatchSplats::clear() {
  beauty.clear();
  for (std::vector<PixelSplat>& part : parts) part.clear();
}

bool SplatPlacer::add(const Splat& splat, std::span<const SplatPart> parts, uint64_t random,
                      BatchSplats& into) const {
  const auto placed = place(splat, random);
  if (!placed) return true;
  if (!add_splat(*placed, into.beauty)) return false;
  for (const SplatPart& part : parts) {
    // Shares of what counts count as well, and fall into the same pixel.
    const auto share = place({splat.film, part.value}, random);
    if (share) add_splat(*share, into.parts[part.part]);
  }
  return true;
}

SplatPlacer::Choice SplatPlacer::choose(float at, float u) const {
  // All pixels whose centres are within the radius; the filter is 0 for one too many at either end.
  const int first = static_cast<int>(std::floor(at - 0.5F - radius_));
  const int last = static_cast<int>(std::ceil(at - 0.5F + radius_));
  std::array<float, kMostPixels> values;
  const int count = std::min(last - first + 1, kMostPixels);
  float total = 0.0F;
  for (int i = 0; i < count; ++i) {
    const float f = filter_.evaluate_along(at - (static_cast<float>(first + i) + 0.5F));
    values[static_cast<size_t>(i)] = f;
    total += std::fabs(f);
  }
  Choice choice;
  float left = u * total;
  for (int i = 0; i < count; ++i) {
    const float f = values[static_cast<size_t>(i)];
    if (f == 0.0F) continue;
    choice = {first + i, f < 0.0F ? -total : total};
    left -= std::fabs(f);
    if (left < 0.0F) break;
  }
  return choice;
}

std::optional<PixelSplat> SplatPlacer::place(const Splat& splat, uint64_t random) const {
  // Also false for NaN; what is far outside is no integer.
  const float margin = radius_ + 1.0F;
  if (!(splat.film.x > static_cast<float>(region_.x0) - margin &&
        splat.film.x < static_cast<float>(region_.x1) + margin &&
        splat.film.y > static_cast<float>(region_.y0) - margin &&
        splat.film.y < static_cast<float>(region_.y1) + margin)) {
    return std::nullopt;
  }
  const Choice x = choose(splat.film.x, static_cast<float>(random >> 40U) * 0x1p-24F);
  const Choice y = choose(splat.film.y, static_cast<float>(random >> 16U & 0xFFFFFFU) * 0x1p-24F);
  if (!region_.contains(x.pixel, y.pixel)) return std::nullopt;
  const float weight = x.weight * y.weight;
  if (weight == 0.0F) return std::nullopt;
  PixelSplat placed;
  placed.pixel = static_cast<uint32_t>(int64_t{y.pixel - region_.y0} * region_.width() +
                                       (x.pixel - region_.x0));
  for (int c = 0; c < 3; ++c) placed.value[static_cast<size_t>(c)] = splat.value[c] * weight;
  return placed;
}

}  // namespace hyades::core
