#pragma once

#include "core/scene/appearance.h"

/// Makers of the kinds of textures, for the table in texture_makers.cpp.
namespace hyades::core {

using TextureMaker = Result<TexturePtr> (*)(const TextureDesc&, Appearance&);

// Patterns between two colours.
Result<TexturePtr> make_checker(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_brick(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_stripes(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_grid(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_gradient(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_fbm(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_turbulence(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_ridged(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_marble(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_wood(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_cellular(const TextureDesc& desc, Appearance& looks);

// What becomes of other textures.
Result<TexturePtr> make_scale(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_add(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_divided(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_least(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_greatest(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_mixed(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_inverted(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_remapped(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_power(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_threshold(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_ramp(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_hue_saturation(const TextureDesc& desc, Appearance& looks);
Result<TexturePtr> make_channel(const TextureDesc& desc, Appearance& looks);

}  // namespace hyades::core
