#pragma once

#include "core/base/vec.h"
#include "core/textures/pixel_view.h"
#include "core/textures/texture.h"

namespace hyades::core {

/// What a mapping starts from.
enum class MappingSpace {
  uv,
  second_uv,  ///< of meshes that have one
  object,
  world
};

/// How a place becomes texture coordinates. All but `none` give u and v alone, z = 0:
/// `planar` is x and y seen along z; `spherical` and `cylindrical` wrap u around the y axis as
/// spheres and cylinders do (core/geometry/shape.h), the sphere's v from pole to pole, the
/// cylinder's is y.
enum class Projection { none, planar, spherical, cylindrical };

/// coordinate = project(transform * place) * scale + offset. With `uv` and
/// `second_uv` the place is (u, v, 0).
struct MappingDesc {
  MappingSpace space = MappingSpace::object;
  Projection projection = Projection::none;
  Vec3 scale{1.0F};
  Vec3 offset{0.0F};
  Mat4 transform{1.0F};

  /// Whether the coordinate lies in a plane.
  bool flat() const {
    return space == MappingSpace::uv || space == MappingSpace::second_uv ||
           projection != Projection::none;
  }
};

/// The coordinate that a texture reads at a place, and its derivative by the place.
class MappedPoint {
 public:
  MappedPoint(const MappingDesc& desc, const TexturePoint& at);

  const Vec3& coordinate() const { return coordinate_; }

  /// Adds a derivative by the coordinate to the derivatives of `result`.
  void add_gradient(const Vec3& derivative, ScalarGradient& result) const;

  /// What a step along the surface [length, world space] changes of the coordinate; `surface` is
  /// that of the place.
  Vec3 step(const Vec3& along, const SurfacePoint& surface) const;

 private:
  /// Derivative of the projection, at its argument `place_`, along `direction`.
  Vec3 project_step(const Vec3& direction) const;
  /// The transposed derivative.
  Vec3 project_back(const Vec3& derivative) const;

  const MappingDesc& desc_;
  const SurfacePoint* surface_;  ///< null: none is known
  Vec3 place_{0.0F};             ///< transformed, not yet projected
  Vec3 coordinate_{0.0F};
};

/// a * x + b * y, value and derivatives.
inline ScalarGradient weighted_sum(float a, const ScalarGradient& x, float b,
                                   const ScalarGradient& y) {
  return {a * x.value + b * y.value, a * x.d_uv + b * y.d_uv, a * x.d_object + b * y.d_object,
          a * x.d_world + b * y.d_world};
}

}  // namespace hyades::core
