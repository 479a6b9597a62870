#include "core/job/check_colors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/job/fields.h"

namespace hyades::core {
namespace {

float brightest(const Rgb& color) { return std::max({color.r, color.g, color.b}); }

std::string in_words(const Rgb& color) {
  return fmt::format("[{}, {}, {}]", color.r, color.g, color.b);
}

/// How the colour is written if its numbers are bytes.
std::string as_bytes_hint(const Rgb& color) {
  const auto is_byte = [](float x) { return x == std::floor(x) && x <= 255.0F; };
  if (!is_byte(color.r) || !is_byte(color.g) || !is_byte(color.b)) return "";
  return fmt::format(": if they go from 0 to 255, \"#{:02x}{:02x}{:02x}\"",
                     static_cast<int>(color.r), static_cast<int>(color.g),
                     static_cast<int>(color.b));
}

/// A texture that a key of a material takes shares of light from.
struct ShareUse {
  std::string texture;
  std::string key;
};

/// Collects the uses of textures as shares of light.
class SharesIn : public FieldVisitor<SharesIn> {
 public:
  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}
  void name_of(const KeyName& /*key*/, const std::string& /*name*/, NameKind /*kind*/) {}
  void color_input(const KeyName& key, const ColorInput& input, const Range& range) {
    if (range.high <= 1.0 && !input.texture.empty()) {
      uses.push_back({input.texture, std::string(key.name)});
    }
  }
  void color_input(const KeyName& key, const std::optional<ColorInput>& input, const Range& range) {
    if (input) color_input(key, *input, range);
  }

  std::vector<ShareUse> uses;
};

/// Finds the brightest colour that is written in a texture, and the textures that it has others of.
class ColorsIn : public FieldVisitor<ColorsIn> {
 public:
  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}
  void value(std::string_view /*key*/, const ColorInput& input) {
    if (!input.texture.empty()) parts.push_back(input.texture);
    if (!input.texture.empty() || !input.value.is_constant()) return;
    if (brightest(input.value.constant) > brightest(most)) most = input.value.constant;
  }
  void name_of(const KeyName& /*key*/, const std::string& /*name*/, NameKind /*kind*/) {}

  Rgb most{0.0F};
  std::vector<std::string> parts;
};

/// Whether what a texture gives lies between the colours that it is made of.
bool hands_through(const TextureDesc& texture) {
  return std::visit(
      [](const auto& kind) {
        using Kind = std::decay_t<decltype(kind)>;
        return std::is_base_of_v<textures::Pattern, Kind> ||
               std::is_same_v<Kind, textures::Constant> || std::is_same_v<Kind, textures::Ramp> ||
               std::is_same_v<Kind, textures::Mix>;
      },
      texture.kind);
}

bool is_temperature(const Rgb& color) {
  return color.r == color.g && color.g == color.b && color.r >= 1000.0F && color.r <= 20000.0F &&
         std::fmod(color.r, 50.0F) == 0.0F;
}

void doubt(const std::string& whose, const Animated<Rgb>& color, std::vector<std::string>& doubts) {
  if (!color.is_constant()) return;
  const Rgb& c = color.constant;
  // A strength may well be written as a grey, but for white in bytes.
  const bool grey = c.r == c.g && c.g == c.b && c.r != 255.0F;
  if (is_temperature(c)) {
    doubts.push_back(fmt::format(
        "{} has the colour {}, which is that many times white: expected '{}K' if it is the "
        "temperature of a black body",
        whose, c.r, c.r));
  } else if (!grey && brightest(c) >= 100.0F && !as_bytes_hint(c).empty()) {
    doubts.push_back(fmt::format("{} has the colour {}, which makes it up to {} times as bright{}",
                                 whose, in_words(c), brightest(c), as_bytes_hint(c)));
  }
}

}  // namespace

std::vector<std::string> doubtful_light_colors(const Job& job) {
  std::vector<std::string> doubts;
  for (const LightDesc& light : job.lights) {
    std::visit([&](const auto& kind) { doubt("light '" + light.name + "'", kind.color, doubts); },
               light.kind);
  }
  for_each_object(job, [&](const ObjectDesc& object) {
    if (!object.emit || !object.emit->color.texture.empty()) return;
    doubt("the light of object '" + object.name + "'", object.emit->color.value, doubts);
  });
  if (job.environment) doubt("the environment", job.environment->color, doubts);
  return doubts;
}

void check_texture_colors(ReadContext& context) {
  std::map<std::string, const TextureDesc*> all;
  for (const TextureDesc& texture : context.job.textures) all.emplace(texture.name, &texture);
  std::set<std::string> seen;
  for (const MaterialDesc& material : context.job.materials) {
    SharesIn shares;
    MaterialDesc::fields(material, shares);
    while (!shares.uses.empty()) {
      const ShareUse use = std::move(shares.uses.back());
      shares.uses.pop_back();
      const auto found = all.find(use.texture);
      if (found == all.end() || !hands_through(*found->second)) continue;
      if (!seen.insert(use.texture).second) continue;
      const TextureDesc& texture = *found->second;
      ColorsIn colors;
      TextureDesc::fields(texture, colors);
      for (std::string& part : colors.parts) shares.uses.push_back({std::move(part), use.key});
      if (brightest(colors.most) <= 1.0F) continue;
      context.complain(texture.where,
                       fmt::format("texture '{}' has the colour {} and is the {} of material '{}', "
                                   "expected at most 1{}",
                                   texture.name, in_words(colors.most), use.key, material.name,
                                   as_bytes_hint(colors.most)));
    }
  }
}

}  // namespace hyades::core
