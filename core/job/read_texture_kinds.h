#pragma once

#include "core/job/map_reader.h"

/// What each kind of texture reads, for the table in read_textures.cpp.
namespace hyades::core {

/// Where a texture lies: `mapping`, `scale` and `offset`.
void read_mapping(MapReader& reader, TextureDesc& texture);

// Patterns between two colours.
void read_checker(MapReader& reader, TextureDesc& texture);
void read_perlin(MapReader& reader, TextureDesc& texture);
void read_perlin_4d(MapReader& reader, TextureDesc& texture);
void read_fbm(MapReader& reader, TextureDesc& texture);
void read_fbm_4d(MapReader& reader, TextureDesc& texture);
void read_fractal(MapReader& reader, TextureDesc& texture);
void read_layers(MapReader& reader, TextureDesc& texture);
void read_cellular(MapReader& reader, TextureDesc& texture);
void read_brick(MapReader& reader, TextureDesc& texture);
void read_lines(MapReader& reader, TextureDesc& texture);
void read_gradient(MapReader& reader, TextureDesc& texture);

// What becomes of other textures.
void read_product(MapReader& reader, TextureDesc& texture);
void read_pair(MapReader& reader, TextureDesc& texture);
void read_texture_mix(MapReader& reader, TextureDesc& texture);
void read_invert(MapReader& reader, TextureDesc& texture);
void read_remap(MapReader& reader, TextureDesc& texture);
void read_power(MapReader& reader, TextureDesc& texture);
void read_threshold(MapReader& reader, TextureDesc& texture);
void read_ramp(MapReader& reader, TextureDesc& texture);
void read_hue_saturation(MapReader& reader, TextureDesc& texture);
void read_channel(MapReader& reader, TextureDesc& texture);

}  // namespace hyades::core
