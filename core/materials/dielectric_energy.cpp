#include "core/materials/dielectric_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace hyades::core {
namespace {

/// Tables lie even in x, where (eta - 1) / (eta + 1) = x |x|: all indices from 0 to infinity, close
/// around 1, where the critical angle moves with the root of eta - 1.
constexpr int kTables = 257;

float eta_of(int node) {
  const int from_middle = node - (kTables - 1) / 2;
  const float x = static_cast<float>(from_middle) / static_cast<float>((kTables - 1) / 2);
  const float ratio = x * std::fabs(x);
  return (1.0F + ratio) / (1.0F - ratio);
}

const FacetEnergy* table_at(int node) {
  static std::array<std::once_flag, kTables> made;
  static std::array<std::unique_ptr<const FacetEnergy>, kTables> tables;
  std::call_once(made[node],
                 [node] { tables[node] = std::make_unique<FacetEnergy>(eta_of(node)); });
  return tables[node].get();
}

/// The part of diffuse light that a smooth surface reflects into the rarer of its two sides, of
/// light from there: a fit of Kulla and Conty's (2017), within 0.01.
float mean_reflectance_from_outside(float eta) {
  return (eta - 1.0F) / (4.08567F + 1.00071F * eta);
}

/// Light that meets facets of colour `f` until it escapes; `loss` of it meets another one each
/// time.
Rgb escaping(const Rgb& f, float loss) { return f * (1.0F - loss) / (Rgb(1.0F) - f * loss); }

}  // namespace

DielectricEnergy::DielectricEnergy(float eta) {
  const float ratio = (eta - 1.0F) / (eta + 1.0F);
  const float x = std::copysign(std::sqrt(std::fabs(ratio)), ratio);
  const float scaled = std::clamp(0.5F + 0.5F * x, 0.0F, 1.0F) * static_cast<float>(kTables - 1);
  const int node = std::min(static_cast<int>(scaled), kTables - 2);
  low_ = table_at(node);
  high_ = table_at(node + 1);
  part_ = scaled - static_cast<float>(node);
}

float DielectricEnergy::reflectance(float cosine, float alpha) const {
  const FacetEnergy::Place place(cosine, alpha);
  const float low = low_->reflectance(place);
  return low + part_ * (high_->reflectance(place) - low);
}

float DielectricEnergy::mean_loss(float alpha) const {
  const float low = low_->mean_loss(alpha);
  return low + part_ * (high_->mean_loss(alpha) - low);
}

LostGlassLight::LostGlassLight(float ior, float alpha, const Rgb& transmission,
                               const Rgb& reflection)
    : alpha_(alpha), sides_{{DielectricEnergy(ior)}, {DielectricEnergy(1.0F / ior)}} {
  const float dense = std::max(ior, 1.0F / ior);
  const float from_rare = 1.0F - mean_reflectance_from_outside(dense);
  const float from_dense = from_rare / (dense * dense);
  const float transmits[2] = {ior >= 1.0F ? from_rare : from_dense,
                              ior >= 1.0F ? from_dense : from_rare};
  for (Side& side : sides_) side.loss = side.energy.mean_loss(alpha);
  const float most = std::max(sides_[0].loss, sides_[1].loss);
  if (!(std::min(sides_[0].loss, sides_[1].loss) > 0.0F)) return;
  Rgb both(0.0F);
  for (int a = 0; a < 2; ++a) {
    Side& side = sides_[a];
    side.reflected = 1.0F - transmits[a] * sides_[1 - a].loss / most;
    side.scale = kInvPi / side.loss;
    const Rgb f = reflection * (1.0F - transmits[a]) + transmission * transmits[a];
    const Rgb escapes = escaping(f, side.loss);
    side.tint = f * escapes;
    both += escapes;
  }
  transmitted_tint_ = 0.5F * transmission * both;
}

float LostGlassLight::part(const Vec3& w) const {
  return 1.0F - sides_[w.z < 0.0F].energy.reflectance(std::fabs(w.z), alpha_);
}

Rgb LostGlassLight::evaluate(const Vec3& wo, const Vec3& wi) const {
  const Side& side = sides_[wo.z < 0.0F];
  const Side& other = sides_[wi.z < 0.0F];
  const float both = part(wo) * part(wi) * std::fabs(wi.z) * other.scale;
  return &side == &other ? side.tint * (side.reflected * both)
                         : transmitted_tint_ * ((1.0F - side.reflected) * both);
}

}  // namespace hyades::core
