#pragma once

#include "core/geometry/surface_point.h"
#include "core/materials/make_material.h"

/// Looking up the parameters of a material at a surface point.
namespace hyades::core {

inline TexturePoint texture_point(const SurfacePoint& p) {
  return {p.uv, transform_point(p.world_to_object, p.position), p.position, &p};
}

/// A number held within [0, 1]; NaN becomes 0.
inline float unit_clamp(float x) { return x > 0.0F ? (x < 1.0F ? x : 1.0F) : 0.0F; }

inline Rgb unit_clamp(const Rgb& c) { return {unit_clamp(c.x), unit_clamp(c.y), unit_clamp(c.z)}; }

/// A reflectance: clamped, since a texture may hold anything and a surface must not create energy.
inline Rgb reflectance_at(const ColorParam& param, const SurfacePoint& p) {
  return unit_clamp(param.texture ? param.texture->color(texture_point(p)) : param.value);
}

/// A number as it is.
inline float number_at(const ScalarParam& param, const SurfacePoint& p) {
  return param.texture ? param.texture->scalar(texture_point(p)) : param.value;
}

/// A parameter whose range is [0, 1].
inline float fraction_at(const ScalarParam& param, const SurfacePoint& p) {
  return unit_clamp(param.texture ? param.texture->scalar(texture_point(p)) : param.value);
}

}  // namespace hyades::core
