#include "core/job/read_color.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/color.h"
#include "core/job/read_components.h"

namespace hyades::core {

namespace {

/// "3200K" -> 3200.
bool parse_kelvin(std::string_view text, double& kelvin) {
  return text.ends_with('K') && parse_number(text.substr(0, text.size() - 1), kelvin);
}

bool accept(const ValueSite& site, const YamlNode& node, const Rgb& color, Animated<Rgb>& target) {
  for (int i = 0; i < 3; ++i) {
    if (site.range.contains(color[i])) continue;
    site.context.complain(
        node.where, fmt::format("{} is {}, whose linear {} is {:.4g}, expected {} per channel",
                                site.label, describe(node),
                                i == 0   ? "red"
                                : i == 1 ? "green"
                                         : "blue",
                                color[i], site.range.describe()));
    return false;
  }
  target = Animated<Rgb>(color);
  return true;
}

bool read_list(const ValueSite& site, const YamlNode& node, Animated<Rgb>& target) {
  if (node.list.size() != 3) {
    complain_mismatch(site, node, expected_color(site.range));
    return false;
  }
  Animated<Rgb> result;
  bool good = true;
  for (size_t i = 0; i < 3; ++i) {
    const ValueSite item{site.context, fmt::format("{}[{}]", site.label, i), site.range};
    good &= read_component(item, *node.list[i], result.constant[static_cast<int>(i)],
                           result.expressions[i]);
  }
  if (good) target = result;
  return good;
}

}  // namespace

std::string expected_color(const Range& range) {
  return "a colour: " + range.describe() + ", [r, g, b], \"#rrggbb\" or 3200K";
}

bool looks_like_color(std::string_view text) {
  double number = 0.0;
  return text.starts_with('#') || text.starts_with('=') || parse_number(text, number) ||
         parse_kelvin(text, number);
}

bool refuse_texture(const ValueSite& site, const YamlNode& node) {
  const std::vector<std::string>& textures =
      site.context.given[static_cast<size_t>(NameKind::texture)];
  const bool named = node.kind == YamlNode::Kind::scalar && !looks_like_color(node.scalar) &&
                     std::find(textures.begin(), textures.end(), node.scalar) != textures.end();
  const bool in_place = node.kind == YamlNode::Kind::map && node.find("keys") == nullptr &&
                        node.find("type") != nullptr;
  if (!named && !in_place) return false;
  site.context.complain(node.where,
                        fmt::format("{} is a texture; here only a colour is allowed", site.label));
  return true;
}

bool read_color(const ValueSite& site, const YamlNode& node, Animated<Rgb>& target) {
  if (node.kind == YamlNode::Kind::list) return read_list(site, node, target);
  if (refuse_texture(site, node)) return false;
  if (node.kind != YamlNode::Kind::scalar || !looks_like_color(node.scalar)) {
    complain_mismatch(site, node, expected_color(site.range));
    return false;
  }
  if (node.scalar.starts_with('#')) {
    const auto color = parse_hex_color(node.scalar);
    if (color) return accept(site, node, *color, target);
    complain_mismatch(site, node, expected_color(site.range));
    return false;
  }
  double kelvin = 0.0;
  if (parse_kelvin(node.scalar, kelvin)) {
    if (kelvin >= 500.0 && kelvin <= 100'000.0) {
      return accept(site, node, blackbody_color(static_cast<float>(kelvin)), target);
    }
    complain_mismatch(site, node, "a black body from 500K to 100000K");
    return false;
  }
  Animated<float> grey;
  if (!read_component(site, node, grey.constant, grey.expressions[0])) return false;
  target = Animated<Rgb>(Rgb(grey.constant));
  target.expressions.fill(grey.expressions[0]);
  return true;
}

}  // namespace hyades::core
