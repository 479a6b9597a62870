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

  /// The share of the light that meets the surface at `point`; the rest passes straight through, as
  /// through a null surface: no scattering event. 0..1, the same from both sides. bsdf_at() is what
  /// becomes of the light that meets it.
  virtual float opacity(const SurfacePoint& /*point*/) const { return 1.0F; }

  /// Whether opacity() can be below 1 anywhere.
  virtual bool is_cutout() const { return false; }

  /// Whether what its BSDFs reflect diffusely, if anything, they reflect as Lambert's does, evenly
  /// and none of it to or from some directions less: then layers on top can keep all of it.
  virtual bool diffuses_evenly() const { return false; }

  /// Index of refraction of what is behind the surface; 0 where light is not refracted.
  virtual float index() const { return 0.0F; }
};

}  // namespace hyades::core
