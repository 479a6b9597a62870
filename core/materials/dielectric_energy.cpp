#include "core/materials/dielectric_energy.h"

#include <algorithm>
#include <cmath>

#include "core/materials/index_tables.h"

namespace hyades::core {
namespace {

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
  const auto [low, high, part] = IndexTables<FacetEnergy>::at(eta);
  low_ = low;
  high_ = high;
  part_ = part;
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
