#pragma once

#include "core/base/frame.h"
#include "core/geometry/surface_point.h"
#include "core/materials/bsdf.h"

namespace hyades::core {

/// A surface's BSDF as a function of place. Immutable and thread-safe.
class Material {
 public:
  virtual ~Material() = default;

  /// The BSDF at `point`, made in `arena`; null where the surface only absorbs (black). `frame`
  /// comes in as the basis around point.ns with s along dpdu; a bump map turns it (never past the
  /// geometric horizon of ng). Textures are looked up at point.uv and at its object-space position.
  virtual const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const = 0;

  /// True for the null material: the integrator walks through without a scattering event.
  virtual bool is_null() const { return false; }

  /// Whether what it transmits comes into the body whose surface it is, as through glass (and not
  /// through a thin pane), so that another medium begins there.
  virtual bool leads_inside() const { return false; }

  /// Index of refraction of what is behind the surface; 0 where light is not refracted.
  virtual float index() const { return 0.0F; }
};

}  // namespace hyades::core
