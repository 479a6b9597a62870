#include "core/materials/interface_energy.h"

#include <algorithm>
#include <cmath>

#include "core/base/fp_mode.h"
#include "core/materials/energy_grid.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"
#include "core/materials/index_tables.h"

namespace hyades::core {
namespace {

/// Mean weight of visible normals over a lattice of the golden ratio, on the half that the other
/// half mirrors. Of smooth facets there is one.
float integrate(float cosine, float alpha, float eta) {
  constexpr int kPoints = 128;
  constexpr float kGoldenRatio = 0.618033988749895F;
  if (alpha < Ggx::kLeastAlpha) return fresnel_dielectric(cosine, eta).reflectance;
  const Ggx facets{alpha};
  const float z = std::max(cosine, 1e-6F);
  const Vec3 wo(std::sqrt(1.0F - z * z), 0.0F, z);
  float sum = 0.0F;
  float v = 0.5F;
  for (int i = 0; i < kPoints; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / kPoints;
    v += kGoldenRatio;
    if (v >= 1.0F) v -= 1.0F;
    const Vec3 m = facets.sample_normal(wo, {v, 0.5F + 0.5F * u});
    const Vec3 back = reflected(wo, m);
    if (!(back.z > 0.0F)) continue;
    const float o_m = std::clamp(glm::dot(wo, m), 0.0F, 1.0F);
    sum += fresnel_dielectric(o_m, eta).reflectance * facets.reflect_weight(wo, back);
  }
  return std::min(sum / kPoints, 1.0F);
}

}  // namespace

InterfaceTable::InterfaceTable(float eta) {
  // The table is part of the picture: the same bits whoever asks first.
  const FpMode mode;
  for (int row = 0; row < kRows; ++row) {
    const float roughness = static_cast<float>(row) / (kRows - 1);
    const float alpha = roughness * roughness;
    for (int column = 0; column < kCosines; ++column) {
      const float x = static_cast<float>(column) / (kCosines - 1);
      reflected_[row][column] = integrate(x * x, alpha, eta);
    }
  }
  for (int row = 0; row < kRows; ++row) {
    const float roughness = static_cast<float>(row) / (kRows - 1);
    // Of the interpolated table, so that what is reflected and the rest add up to one.
    constexpr int kSteps = 256;
    double rest = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      const float x = (static_cast<float>(step) + 0.5F) / kSteps;
      rest += double{(1.0F - reflected(x * x, roughness * roughness)) * 4.0F * x * x * x};
    }
    mean_rest_[row] = static_cast<float>(rest / kSteps);
  }
}

float InterfaceTable::reflected(float cosine, float alpha) const {
  const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (kCosines - 1);
  const float y = std::sqrt(std::clamp(alpha, 0.0F, 1.0F)) * (kRows - 1);
  const int column = std::min(static_cast<int>(x), kCosines - 2);
  const int row = std::min(static_cast<int>(y), kRows - 2);
  const auto along = [&](const std::array<float, kCosines>& values) {
    return lerp(values[column], values[column + 1], x - static_cast<float>(column));
  };
  return lerp(along(reflected_[row]), along(reflected_[row + 1]), y - static_cast<float>(row));
}

float InterfaceTable::mean_rest(float alpha) const {
  const float y = std::sqrt(std::clamp(alpha, 0.0F, 1.0F)) * (kRows - 1);
  const int row = std::min(static_cast<int>(y), kRows - 2);
  return lerp(mean_rest_[row], mean_rest_[row + 1], y - static_cast<float>(row));
}

InterfaceEnergy::InterfaceEnergy(float eta) {
  const auto [low, high, part] = IndexTables<InterfaceTable>::at(eta);
  low_ = low;
  high_ = high;
  part_ = part;
}

}  // namespace hyades::core
