#pragma once

#include "core/scene/appearance.h"

/// Makers of the types of textures, for texture_makers.cpp.
namespace hyades::core {

// Patterns between two colours.
Result<TexturePtr> make_texture(const textures::Checker& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Brick& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Stripes& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Grid& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Gradient& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Perlin3d& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Perlin4d& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Fbm3d& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Fbm4d& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Turbulence& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Ridged& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Marble& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Wood& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Cellular& desc, Appearance& looks);

// What becomes of other textures.
Result<TexturePtr> make_texture(const textures::Scale& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Add& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Divide& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Min& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Max& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Mix& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Invert& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Remap& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Power& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Threshold& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::Ramp& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::HueSaturation& desc, Appearance& looks);
Result<TexturePtr> make_texture(const textures::ChannelOf& desc, Appearance& looks);

}  // namespace hyades::core
