#pragma once

#include "core/base/vec.h"
#include "core/geometry/surface_point.h"

namespace hyades::core {

/// Where a texture is looked up.
struct TexturePoint {
  Vec2 uv{0.0F};
  Vec3 object{0.0F};  ///< object-space position
  Vec3 world{0.0F};
  /// The surface there, which outlives the look-up. Null: a place without a surface, where images
  /// are read as finely as they can be.
  const SurfacePoint* surface = nullptr;
  /// Images are to be read as finely as they can be, whoever sees the surface.
  bool finest = false;
};

/// A scalar and how it changes: partial derivatives with respect to each coordinate it may depend
/// on.
struct ScalarGradient {
  float value = 0.0F;
  Vec2 d_uv{0.0F};
  Vec3 d_object{0.0F};
  Vec3 d_world{0.0F};
};

/// The luminance of linear Rec.709 (core/base/vec.h) as weights of red, green, blue and alpha.
inline constexpr Vec4 kLuminance{0.2126F, 0.7152F, 0.0722F, 0.0F};

/// A colour that varies over a surface or through space, already at its frame's time. Where a
/// number is wanted it is the colour's luminance. Immutable and thread-safe.
class Texture {
 public:
  virtual ~Texture() = default;

  /// Linear Rec.709.
  virtual Rgb color(const TexturePoint& at) const = 0;

  /// How much is there, 0..1: of images that say it (and what only puts images together); 1 of all
  /// others.
  virtual float alpha(const TexturePoint& /*at*/) const { return 1.0F; }

  /// The luminance of color(): of greys the grey exactly.
  float scalar(const TexturePoint& at) const {
    const Rgb c = color(at);
    return c.x == c.y && c.y == c.z ? c.x : luminance(c);
  }

  /// Red, green, blue and alpha summed up by `weights`, with the sum's exact derivatives (analytic,
  /// or those of the interpolation).
  virtual ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const = 0;

  /// scalar() with its derivatives.
  ScalarGradient scalar_gradient(const TexturePoint& at) const { return gradient(at, kLuminance); }
};

}  // namespace hyades::core
