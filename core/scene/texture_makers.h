#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/appearance.h"

namespace hyades::core {

/// The texture that `desc` describes at the moment of `looks`, which gives what it refers to.
Result<TexturePtr> make_texture(const TextureDesc& desc, Appearance& looks);

/// How an image texture reads its file.
Result<ImageUse> image_use_of(const textures::Image& desc);

/// The names that can be made: those of core/job/texture_desc.h.
std::vector<std::string> made_color_spaces();
std::vector<std::string> made_wraps();
std::vector<std::string> made_texture_filters();
std::vector<std::string> made_mappings();
std::vector<std::string> made_mapping_spaces();
std::vector<std::string> made_channels();
std::vector<std::string> made_cell_metrics();
std::vector<std::string> made_cell_features();
std::vector<std::string> made_gradient_shapes();
std::vector<std::string> made_remap_ends();
std::vector<std::string> made_ramp_shapes();

}  // namespace hyades::core
