#pragma once

#include <string>

#include "core/job/yaml_build.h"

/// Colours and numbers of materials that a picture may stand for, as a job's textures.
namespace hyades::core {

/// A colour: one number where all channels are the same.
YamlPtr color_node(const Rgb& color);

/// Texture `input` times the number, colour or texture `factor`.
YamlPtr product(const YamlPtr& input, const YamlPtr& factor);

/// `factor` times a texture, its name or the texture itself; the factor alone where that is null or
/// empty or the factor is 0, the texture alone where it is 1.
YamlPtr tinted(const Rgb& factor, const YamlPtr& texture);
YamlPtr tinted(const Rgb& factor, const std::string& name);
YamlPtr scaled(float factor, const YamlPtr& texture);
YamlPtr scaled(float factor, const std::string& name);

}  // namespace hyades::core
