#include "core/materials/facet_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/fp_mode.h"
#include "core/materials/fresnel.h"
#include "core/materials/local.h"

namespace hyades::core {
namespace {

/// Points for 0.001 (mirrors, which cost less: 0.0005). What is refracted into a denser medium
/// hardly depends on the facet.
int points_for(float eta) {
  if (std::isinf(eta)) return 1024;
  return eta < 1.0F ? 512 : 256;
}

/// Mean weight of visible normals over a lattice of the golden ratio, on the half that the other
/// half mirrors.
float integrate_reflectance(float cosine, float alpha, float eta) {
  const int points = points_for(eta);
  constexpr float kGoldenRatio = 0.618033988749895F;
  const Ggx facets{alpha};
  // A horizontal direction sees facets like one just above.
  const float z = std::max(cosine, 1e-7F);
  const Vec3 wo(std::sqrt(1.0F - z * z), 0.0F, z);
  float sum = 0.0F;
  float v = 0.5F;
  for (int i = 0; i < points; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(points);
    v += kGoldenRatio;
    if (v >= 1.0F) v -= 1.0F;
    const Vec3 m = facets.sample_normal(wo, {v, 0.5F + 0.5F * u});
    const float o_m = std::clamp(glm::dot(wo, m), 0.0F, 1.0F);
    const auto [reflectance, cos_t] =
        std::isinf(eta) ? DielectricInterface{} : fresnel_dielectric(o_m, eta);
    const Vec3 back = reflected(wo, m);
    if (back.z > 0.0F) sum += reflectance * facets.reflect_weight(wo, back);
    if (!(reflectance < 1.0F)) continue;
    const Vec3 through = (o_m / eta - cos_t) * m - wo / eta;
    if (through.z < 0.0F) {
      sum += (1.0F - reflectance) * facets.reflect_weight(wo, above(through));
    }
  }
  return std::min(sum / static_cast<float>(points), 1.0F);
}

}  // namespace

FacetEnergy::FacetEnergy(float eta) {
  // The table is part of the picture: the same bits whoever asks first.
  const FpMode mode;
  for (int row = 0; row < kAlphas; ++row) {
    const float roughness = static_cast<float>(row) / static_cast<float>(kAlphas - 1);
    // The first row is the limit of small alpha, where E depends on cosine / alpha alone.
    const float alpha = std::max(roughness * roughness, 1e-3F);
    for (int column = 0; column < kCosines; ++column) {
      const float x = static_cast<float>(column) / static_cast<float>(kCosines - 1);
      reflectance_[row][column] = integrate_reflectance(energy_cosine(x, alpha), alpha, eta);
    }
  }
  // Of the interpolated table, so that the two lobes add up to one; even steps in the column.
  constexpr int kSteps = 512;
  mean_loss_[0] = 0.0F;
  for (int i = 1; i < kMeans; ++i) {
    const float roughness = static_cast<float>(i) / static_cast<float>(kMeans - 1);
    const float alpha = roughness * roughness;
    double lost = 0.0;
    float last = 0.0F;
    for (int step = 1; step <= kSteps; ++step) {
      const float next = energy_cosine(static_cast<float>(step) / kSteps, alpha);
      const float middle = 0.5F * (last + next);
      lost += double{1.0F - reflectance(middle, alpha)} * (2.0 * middle * (next - last));
      last = next;
    }
    mean_loss_[i] = static_cast<float>(lost);
  }
}

const FacetEnergy& FacetEnergy::table() {
  static const FacetEnergy energy(std::numeric_limits<float>::infinity());
  return energy;
}

FacetEnergy::Place::Place(float cosine, float alpha)
    : row(GridPlace::at(std::sqrt(alpha), kAlphas)),
      column(GridPlace::at(energy_column(cosine, alpha), kCosines)) {}

float FacetEnergy::reflectance(const Place& place) const {
  const auto& [row, column] = place;
  return lerp(column.in(reflectance_[row.node]), column.in(reflectance_[row.node + 1]), row.part);
}

float FacetEnergy::mean_loss(float alpha) const {
  return GridPlace::at(std::sqrt(alpha), kMeans).in(mean_loss_);
}

}  // namespace hyades::core
