#include "core/scene/medium_makers.h"

#include <utility>
#include <variant>

#include "core/media/albedo_inversion.h"

namespace hyades::core {
namespace {

Phase phase_of(const MediumDesc& desc, const JobTime& time) {
  if (desc.phase == "rayleigh") return Phase::rayleigh();
  const float blend = desc.blend.at(time);
  if (blend == 0.0F) return Phase::henyey_greenstein(desc.g.at(time));
  return Phase::two_lobes(desc.g.at(time), desc.g2.at(time), blend);
}

}  // namespace

Coefficients coefficients_of(const MediumDesc& desc, const JobTime& time, float units) {
  Coefficients found;
  if (desc.albedo) {
    const Rgb extinction = desc.density          ? desc.density->at(time)
                           : desc.mean_free_path ? Rgb(1.0F) / desc.mean_free_path->at(time)
                                                 : Rgb(1.0F);
    found.scattering = desc.albedo->at(time) * extinction;
    found.absorption = extinction - found.scattering;
  } else {
    found.absorption = desc.absorption.at(time);
    found.scattering = desc.scattering.at(time);
  }
  const float scale = desc.scale.at(time) / units;
  found.absorption *= scale;
  found.scattering *= scale;
  if (desc.emission) {
    found.emission = desc.emission->color.at(time) * desc.emission->strength.at(time) / units;
  }
  return found;
}

MediumPtr make_medium(const MediumDesc& desc, const JobTime& time, float units) {
  const Coefficients made = coefficients_of(desc, time, units);
  return make_homogeneous(made.absorption, made.scattering, made.emission, phase_of(desc, time));
}

MediumPtr make_medium_in(const MediumDesc& desc, const JobTime& time, float units,
                         const PlacedVolume& volume, const std::vector<Mat4>& body_to_world) {
  std::vector<Mat4> to_world;
  to_world.reserve(body_to_world.size());
  for (const Mat4& m : body_to_world) to_world.push_back(m * volume.to_body);
  const FieldPlace place(std::move(to_world));
  const Coefficients made = coefficients_of(desc, time, units);
  const float step = desc.varying->march * units;
  return step > 0.0F ? make_marching(volume.volume, place, made, phase_of(desc, time), step)
                     : make_varying(volume.volume, place, made, phase_of(desc, time));
}

MediumPtr make_subsurface(const MaterialDesc& desc, const JobTime& time, float units) {
  const SubsurfaceDesc& subsurface = *subsurface_of(desc);
  BodyColor body;
  body.color = subsurface.color.at(time);
  body.radius = subsurface.radius.at(time) * subsurface.scale.at(time) * units;
  body.g = subsurface.g.at(time);
  body.index = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.ior; }) {
          return kind.ior.at(time);
        } else {
          return 1.0F;
        }
      },
      desc.kind);
  const ScatteringNumbers made = scattering_of(body);
  return make_homogeneous(made.absorption, made.scattering, Rgb(0.0F),
                          Phase::henyey_greenstein(Rgb(body.g)));
}

}  // namespace hyades::core
