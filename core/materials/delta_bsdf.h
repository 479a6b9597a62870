#pragma once

#include "core/materials/bsdf.h"

namespace hyades::core {

/// A BSDF of delta lobes only: nothing to evaluate.
class DeltaBsdf : public Bsdf {
 public:
  Rgb evaluate(const Vec3&, const Vec3&, TransportMode) const final { return Rgb(0.0F); }
  float pdf(const Vec3&, const Vec3&, TransportMode) const final { return 0.0F; }
  bool has_smooth() const final { return false; }
};

}  // namespace hyades::core
