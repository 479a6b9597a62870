#pragma once

#include <gtest/gtest.h>

#include "core/textures/texture.h"

namespace hyades::core {

/// Central differences of scalar() by every coordinate against scalar_gradient().
inline void expect_gradient(const Texture& texture, const TexturePoint& at, float tolerance,
                            float h = 0x1p-10F) {
  const ScalarGradient g = texture.scalar_gradient(at);
  EXPECT_FLOAT_EQ(g.value, texture.scalar(at));
  const auto slope = [&](auto member, int d) {
    TexturePoint high = at;
    TexturePoint low = at;
    (high.*member)[d] += h;
    (low.*member)[d] -= h;
    return (texture.scalar(high) - texture.scalar(low)) / (2.0F * h);
  };
  for (int d = 0; d < 2; ++d) EXPECT_NEAR(g.d_uv[d], slope(&TexturePoint::uv, d), tolerance);
  for (int d = 0; d < 3; ++d) {
    EXPECT_NEAR(g.d_object[d], slope(&TexturePoint::object, d), tolerance);
    EXPECT_NEAR(g.d_world[d], slope(&TexturePoint::world, d), tolerance);
  }
}

}  // namespace hyades::core
