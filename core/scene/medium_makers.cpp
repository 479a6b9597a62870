#include "core/scene/medium_makers.h"

namespace hyades::core {
namespace {

/// Of `desc`, in metres.
Coefficients coefficients_of(const MediumDesc& desc, const JobTime& time, float units) {
  Coefficients found;
  if (desc.albedo) {
    const Rgb extinction =
        desc.density ? desc.density->at(time) : Rgb(1.0F) / desc.mean_free_path->at(time);
    found.scattering = desc.albedo->at(time) * extinction;
    found.absorption = extinction - found.scattering;
  } else {
    found.absorption = desc.absorption.at(time);
    found.scattering = desc.scattering.at(time);
  }
  const float scale = desc.scale.at(time) / units;
  found.absorption *= scale;
  found.scattering *= scale;
  found.emission = desc.emission.at(time) / units;
  return found;
}

Phase phase_of(const MediumDesc& desc, const JobTime& time) {
  if (desc.phase == "rayleigh") return Phase::rayleigh();
  const float blend = desc.blend.at(time);
  if (blend == 0.0F) return Phase::henyey_greenstein(desc.g.at(time));
  return Phase::two_lobes(desc.g.at(time), desc.g2.at(time), blend);
}

}  // namespace

MediumPtr make_medium(const MediumDesc& desc, const JobTime& time, float units) {
  const Coefficients made = coefficients_of(desc, time, units);
  return make_homogeneous(made.absorption, made.scattering, made.emission, phase_of(desc, time));
}

}  // namespace hyades::core
