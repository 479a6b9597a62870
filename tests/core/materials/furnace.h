#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/core/materials/bsdf_cases.h"

namespace hyades::test {

/// What of uniform light of radiance 1 goes to `wo`, by samples on a lattice (Roberts' R2 sequence
/// over even steps of the lobe's number): within 0.001 of the expectation for `count` 6,000,
/// along the surface, for 30,000, within 0.004; lattices with another `shift` show it.
inline double furnace(const core::Bsdf& bsdf, const core::Vec3& wo, int count, double shift = 0.5) {
  double sum = 0.0;
  double x = shift;
  double y = shift;
  const auto step = [](double& value, double by) {
    value += by;
    value -= std::floor(value);
    return std::fmin(static_cast<float>(value), 0x1.fffffep-1F);
  };
  for (int n = 0; n < count; ++n) {
    const float u = step(x, 0.7548776662466927);
    const float v = step(y, 0.5698402909980532);
    const float lobe = (static_cast<float>(n) + 0.5F) / static_cast<float>(count);
    const auto s = bsdf.sample(wo, lobe, {u, v}, core::TransportMode::importance);
    if (s) sum += double{s->weight.x};
  }
  return sum / count;
}

/// Looked at at seven angles, and where `azimuths` is more than 1 from as many sides within a
/// quarter: whether all light comes back, but for 0.005.
inline ::testing::AssertionResult keeps_all_light(const core::MaterialPtr& material,
                                                  bool inside = false, int azimuths = 1,
                                                  double bound = 0.005) {
  const core::BsdfUnderTest bsdf(material);
  for (const float z : {1.0F, 0.9F, 0.6F, 0.4F, 0.25F, 0.15F, 0.03F}) {
    for (int k = 0; k < azimuths; ++k) {
      const float phi = azimuths > 1 ? 1.5707F * static_cast<float>(k) / (azimuths - 1) : 0.5F;
      const float r = std::sqrt(1.0F - z * z);
      const core::Vec3 wo(r * std::cos(phi), r * std::sin(phi), inside ? -z : z);
      // Along the surface few samples carry much.
      const double back =
          z < 0.1F
              ? 0.5 * (furnace(*bsdf.get(), wo, 30000, 0.5) + furnace(*bsdf.get(), wo, 30000, 0.1))
              : furnace(*bsdf.get(), wo, 6000);
      if (!(std::abs(back - 1.0) <= bound)) {
        return ::testing::AssertionFailure()
               << back << " comes back at cosine " << z << ", azimuth " << phi;
      }
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace hyades::test
