#include "core/materials/sheen.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"
#include "core/base/fp_mode.h"
#include "core/materials/energy_grid.h"

namespace hyades::core {
namespace {

constexpr float kLeastRoughness = 0.3F;

/// E over even steps of the root of the cosine, and of roughness.
constexpr int kCosines = 40;
constexpr int kRows = 17;
struct Table {
  std::array<std::array<float, kCosines>, kRows> reflectance;
  std::array<float, kRows> mean;
};

float roughness_of(int row) {
  return lerp(kLeastRoughness, 1.0F, static_cast<float>(row) / (kRows - 1));
}

/// The integral of f cos over the hemisphere, even steps in cosine and azimuth (half of it: the
/// other half mirrors it).
float integrate(const Fuzz& fuzz, float cosine) {
  constexpr int kSteps = 32;
  constexpr int kTurns = 24;
  const Vec3 wo(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  double sum = 0.0;
  for (int n = 0; n < kTurns; ++n) {
    const float phi = kPi * (static_cast<float>(n) + 0.5F) / kTurns;
    const auto [sine, cosine_phi] = sin_cos(phi);
    for (int m = 0; m < kSteps; ++m) {
      // Steps in the root, for light that comes along the surface.
      const float x = (static_cast<float>(m) + 0.5F) / kSteps;
      const float z = x * x;
      const float r = std::sqrt(1.0F - z * z);
      sum += double{fuzz.reflect(wo, {r * cosine_phi, r * sine, z}) * 2.0F * x};
    }
  }
  return static_cast<float>(sum * (2.0 * double{kPi} / (kSteps * kTurns)));
}

Table make_table() {
  // The table is part of the picture: the same bits whoever asks first.
  const FpMode mode;
  Table table;
  for (int row = 0; row < kRows; ++row) {
    const Fuzz fuzz(roughness_of(row));
    for (int column = 0; column < kCosines; ++column) {
      const float x = std::max(static_cast<float>(column), 0.25F) / (kCosines - 1);
      table.reflectance[row][column] = std::min(1.0F, integrate(fuzz, x * x));
    }
    // Of the interpolated table: even steps in the root of the cosine.
    constexpr int kSteps = 256;
    double sum = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      const float x = (static_cast<float>(step) + 0.5F) / kSteps;
      const float place = x * (kCosines - 1);
      const auto column = static_cast<size_t>(place);
      const auto& values = table.reflectance[row];
      const float between = place - static_cast<float>(column);
      sum += double{lerp(values[column], values[column + 1], between) * 4.0F * x * x * x};
    }
    table.mean[row] = static_cast<float>(sum / kSteps);
  }
  return table;
}

const Table& table() {
  static const Table made = make_table();
  return made;
}

}  // namespace

Fuzz::Fuzz(float roughness) {
  const float r = std::clamp(roughness, kLeastRoughness, 1.0F);
  row_ = (r - kLeastRoughness) / (1.0F - kLeastRoughness) * (kRows - 1);
  const float alpha = r * r;
  exponent_ = 1.0F / alpha;
  scale_ = (2.0F + exponent_) * 0.5F * kInvPi;
  const float p = (1.0F - alpha) * (1.0F - alpha);
  a_ = lerp(21.5473F, 25.3245F, p);
  b_ = lerp(3.82987F, 3.32435F, p);
  c_ = lerp(0.19823F, 0.16801F, p);
  d_ = lerp(-1.97760F, -1.27393F, p);
  e_ = lerp(-4.32054F, -4.85967F, p);
  middle_ = a_ / (1.0F + b_ * pow(0.5F, c_)) + d_ * 0.5F + e_;
}

float Fuzz::hidden(float cosine) const {
  const auto fit = [&](float x) { return a_ / (1.0F + b_ * pow(x, c_)) + d_ * x + e_; };
  return exp(cosine < 0.5F ? fit(cosine) : 2.0F * middle_ - fit(1.0F - cosine));
}

float Fuzz::reflect(const Vec3& wo, const Vec3& wi) const {
  const Vec3 h = wo + wi;
  const float length2 = glm::dot(h, h);
  if (!(wo.z > 0.0F) || !(wi.z > 0.0F) || !(length2 > 0.0F)) return 0.0F;
  const float sine2 = std::min(1.0F, (h.x * h.x + h.y * h.y) / length2);
  const float density = sine2 > 0.0F ? scale_ * pow(sine2, 0.5F * exponent_) : 0.0F;
  return density / (4.0F * wo.z * (1.0F + hidden(wo.z) + hidden(wi.z)));
}

float Fuzz::reflectance(float cosine) const {
  const auto& rows = table().reflectance;
  const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (kCosines - 1);
  const int column = std::min(static_cast<int>(x), kCosines - 2);
  const int row = std::min(static_cast<int>(row_), kRows - 2);
  const auto along = [&](const std::array<float, kCosines>& values) {
    return lerp(values[column], values[column + 1], x - static_cast<float>(column));
  };
  return lerp(along(rows[row]), along(rows[row + 1]), row_ - static_cast<float>(row));
}

float Fuzz::mean_reflectance() const {
  const auto& means = table().mean;
  const int row = std::min(static_cast<int>(row_), kRows - 2);
  return lerp(means[row], means[row + 1], row_ - static_cast<float>(row));
}

}  // namespace hyades::core
