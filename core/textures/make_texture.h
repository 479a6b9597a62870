#pragma once

#include <memory>
#include <string>

#include "core/image/image.h"
#include "core/textures/texture.h"

/// One maker per kind of texture. Composite textures hold their inputs alive.
namespace hyades::core {

using TexturePtr = std::shared_ptr<const Texture>;

TexturePtr make_constant_texture(const Rgb& value);

enum class WrapMode { repeat, clamp, mirror, black };
enum class TextureFilter { bilinear, nearest };

/// uv (0, 0) is the lower left corner of the image, (1, 1) the upper right; looked up at
/// uv * scale + offset. Texel centres lie half a texel inside. Colour from channels R, G, B, else
/// grey from Y, else from the first channel. An image without pixels is black.
TexturePtr make_image_texture(std::shared_ptr<const Image> image, WrapMode wrap,
                              TextureFilter filter, const Vec2& scale = Vec2(1.0F),
                              const Vec2& offset = Vec2(0.0F));

/// What a procedural texture reads as its coordinates.
enum class Mapping { uv, object, world };

/// coordinate = mapping * scale + offset
struct MappingDesc {
  Mapping mapping = Mapping::object;
  Vec3 scale{1.0F};
  Vec3 offset{0.0F};
};

/// Colour a where floor(x) + floor(y) + floor(z) of the mapped coordinate is even, else b (uv: z =
/// 0).
TexturePtr make_checker_texture(TexturePtr a, TexturePtr b, const MappingDesc& mapping);

/// input times factor, per channel; scalar() is the product of their scalar().
TexturePtr make_scale_texture(TexturePtr input, TexturePtr factor);

struct NoiseDesc {
  int dimensions = 3;       ///< 3, or 4 with `time` as the fourth coordinate
  int octaves = 1;          ///< 1 = Perlin noise, more = fBm
  float lacunarity = 2.0F;  ///< frequency ratio of neighbouring octaves
  float gain = 0.5F;        ///< amplitude ratio
  float time = 0.0F;
};

/// (1 - w) a + w b with w = 0.5 + 0.5 noise, clamped to [0, 1]; scalar() is w mapped the same way
/// on the luminances of a and b.
TexturePtr make_noise_texture(TexturePtr a, TexturePtr b, const NoiseDesc& noise,
                              const MappingDesc& mapping);

}  // namespace hyades::core
