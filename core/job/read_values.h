#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/job/read_context.h"

/// Single values: numbers, vectors, colours, and their animated forms. Every function complains
/// itself and leaves its target alone where it returns false.
namespace hyades::core {

/// The value that is being read: how complaints call it and what it accepts.
struct ValueSite {
  ReadContext& context;
  std::string label;  ///< "fov", "size[1]"
  Range range;
};

/// "fov is 'wide', expected a number above 0 and below 180".
void complain_mismatch(const ValueSite& site, const YamlNode& found, const std::string& expected);

/// Whether a text is a finite decimal number ("1", "-.5", "2e3"; not hexadecimal, not quoted).
bool parse_number(std::string_view text, double& value);

/// Whether a text reads as a colour: "#rgb", "#rrggbb", "3200K" or a number.
bool looks_like_color(std::string_view text);

/// Names are 1..100 letters, digits, '_', '-', '.' or inner spaces, and start with a letter, digit
/// or '_'.
bool is_valid_name(std::string_view name);

/// The name that is nearest to `text`: '_' for what names cannot have, so that "shot (1)" and "shot
/// (2)" stay two; "job" where nothing is left.
std::string valid_name(std::string_view text);

bool read_number(const ValueSite& site, const YamlNode& node, float& target);
bool read_integer(const ValueSite& site, const YamlNode& node, int64_t low, int64_t high,
                  int64_t& target);

bool read_animated_rotation(const ValueSite& site, const YamlNode& node, Animated<Vec4>& target);
bool read_animated_number(const ValueSite& site, const YamlNode& node, Animated<float>& target);
bool read_animated_pair(const ValueSite& site, const YamlNode& node, Animated<Vec2>& target);
bool read_animated_vector(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target);
/// One number stands for all three components; [x, y] leaves z as it is.
bool read_animated_scale(const ValueSite& site, const YamlNode& node, Animated<Vec3>& target);
bool read_animated_color(const ValueSite& site, const YamlNode& node, Animated<Rgb>& target);

}  // namespace hyades::core
