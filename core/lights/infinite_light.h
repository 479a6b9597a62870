#pragma once

#include <optional>

#include "core/lights/light.h"

namespace hyades::core {

/// What lights that are infinitely far away have in common: they have no places, only directions.
/// A light path of theirs begins on a disc that covers the world, which the integrator chooses.
class InfiniteLight : public Light {
 public:
  bool is_infinite() const final { return true; }

  std::optional<EmissionSample> sample_emission(float, float, const Vec2&,
                                                const Vec2&) const final {
    return std::nullopt;
  }
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const final {
    return is_delta() ? 1.0F : pdf_direct(Vec3(0.0F), direction, on);
  }
  float pdf_outward(const Vec3&, const Vec3&) const final { return 0.0F; }
};

}  // namespace hyades::core
