#pragma once

#include "core/textures/make_texture.h"

namespace hyades::core {

/// The coordinate that a procedural texture reads at a point.
inline Vec3 map_point(const MappingDesc& desc, const TexturePoint& at) {
  const Vec3 source = desc.mapping == Mapping::uv       ? Vec3(at.uv.x, at.uv.y, 0.0F)
                      : desc.mapping == Mapping::object ? at.object
                                                        : at.world;
  return source * desc.scale + desc.offset;
}

/// Adds a derivative by the mapped coordinate to the derivatives of `result`.
inline void add_mapped_gradient(const MappingDesc& desc, const Vec3& derivative,
                                ScalarGradient& result) {
  const Vec3 d = derivative * desc.scale;
  if (desc.mapping == Mapping::uv) result.d_uv += Vec2(d.x, d.y);
  if (desc.mapping == Mapping::object) result.d_object += d;
  if (desc.mapping == Mapping::world) result.d_world += d;
}

/// a * x + b * y, value and derivatives.
inline ScalarGradient weighted_sum(float a, const ScalarGradient& x, float b,
                                   const ScalarGradient& y) {
  return {a * x.value + b * y.value, a * x.d_uv + b * y.d_uv, a * x.d_object + b * y.d_object,
          a * x.d_world + b * y.d_world};
}

}  // namespace hyades::core
