#include "core/scene/medium_makers.h"

namespace hyades::core {
namespace {

struct Coefficients {
  Rgb absorption{0.0F};
  Rgb scattering{0.0F};
};

Coefficients coefficients_of(const MediumDesc& desc, const JobTime& time) {
  if (!desc.albedo) return {desc.absorption.at(time), desc.scattering.at(time)};
  const Rgb extinction =
      desc.density ? desc.density->at(time) : Rgb(1.0F) / desc.mean_free_path->at(time);
  const Rgb scattering = desc.albedo->at(time) * extinction;
  return {extinction - scattering, scattering};
}

Phase phase_of(const MediumDesc& desc, const JobTime& time) {
  if (desc.phase == "rayleigh") return Phase::rayleigh();
  const float blend = desc.blend.at(time);
  if (blend == 0.0F) return Phase::henyey_greenstein(desc.g.at(time));
  return Phase::two_lobes(desc.g.at(time), desc.g2.at(time), blend);
}

}  // namespace

MediumPtr make_medium(const MediumDesc& desc, const JobTime& time, float units) {
  const Coefficients per_unit = coefficients_of(desc, time);
  const float scale = desc.scale.at(time) / units;
  const Rgb emission = desc.emission.at(time) / units;
  return make_homogeneous(per_unit.absorption * scale, per_unit.scattering * scale, emission,
                          phase_of(desc, time));
}

}  // namespace hyades::core
