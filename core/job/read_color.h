#pragma once

#include <string>

#include "core/job/read_values.h"

namespace hyades::core {

/// A colour that is no keys: a number or expression (grey), [r, g, b] in linear Rec.709, "#rrggbb"
/// (sRGB), or 3200K (black body of luminance 1).
bool read_color(const ValueSite& site, const YamlNode& node, Animated<Rgb>& target);

/// Whether `node` is the name of a texture, or a texture written in place, about which it
/// complains: for places where only a colour is allowed.
bool refuse_texture(const ValueSite& site, const YamlNode& node);

/// What read_color accepts, for complaints.
std::string expected_color(const Range& range);

}  // namespace hyades::core
