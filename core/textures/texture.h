#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// Where a texture is looked up.
struct TexturePoint {
  Vec2 uv{0.0F};
  Vec3 object{0.0F};  ///< object-space position
  Vec3 world{0.0F};
};

/// A scalar and how it changes: partial derivatives with respect to each coordinate it may depend
/// on.
struct ScalarGradient {
  float value = 0.0F;
  Vec2 d_uv{0.0F};
  Vec3 d_object{0.0F};
  Vec3 d_world{0.0F};
};

/// A colour (or number) that varies over a surface or through space, already at its frame's time.
/// Immutable and thread-safe.
class Texture {
 public:
  virtual ~Texture() = default;

  /// Linear Rec.709.
  virtual Rgb color(const TexturePoint& at) const = 0;

  /// The luminance of color(), unless the texture is a number by nature.
  virtual float scalar(const TexturePoint& at) const { return luminance(color(at)); }

  /// scalar() with its exact derivatives (analytic, or those of the interpolation).
  virtual ScalarGradient scalar_gradient(const TexturePoint& at) const = 0;
};

}  // namespace hyades::core
