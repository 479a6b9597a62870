#include "import/obj/mtl_file.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "import/obj/mtl_words.h"

namespace hyades::core {

namespace {

/// A colour: three numbers, or one for all channels. Null, or what was expected.
const char* read_color(std::string_view text, Rgb& color) {
  float parts[3] = {};
  const int count = read_numbers(text, parts);
  if (count != 1 && count != 3) return "expected one or three finite numbers";
  color = count == 1 ? Rgb(parts[0]) : Rgb(parts[0], parts[1], parts[2]);
  return nullptr;
}

using Colors = std::pair<std::string_view, std::optional<Rgb> MtlMaterial::*>;
constexpr Colors kColors[] = {
    {"Kd", &MtlMaterial::diffuse}, {"Ks", &MtlMaterial::specular}, {"Tf", &MtlMaterial::filter}};

using Shares = std::pair<std::string_view, std::optional<float> MtlMaterial::*>;
constexpr Shares kShares[] = {
    {"Pr", &MtlMaterial::roughness},       {"Pm", &MtlMaterial::metallic},
    {"Ps", &MtlMaterial::sheen},           {"Pc", &MtlMaterial::coat},
    {"Pcr", &MtlMaterial::coat_roughness}, {"aniso", &MtlMaterial::anisotropy},
    {"anisor", &MtlMaterial::rotation}};

using Maps = std::pair<std::string_view, MtlMap MtlMaterial::*>;
constexpr Maps kMaps[] = {
    {"map_Kd", &MtlMaterial::diffuse_map},        {"map_Ks", &MtlMaterial::specular_map},
    {"map_Ns", &MtlMaterial::exponent_map},       {"map_Ke", &MtlMaterial::emission_map},
    {"map_d", &MtlMaterial::dissolve_map},        {"map_bump", &MtlMaterial::bump_map},
    {"map_Bump", &MtlMaterial::bump_map},         {"bump", &MtlMaterial::bump_map},
    {"norm", &MtlMaterial::normal_map},           {"map_Kn", &MtlMaterial::normal_map},
    {"map_Pr", &MtlMaterial::roughness_map},      {"map_Pm", &MtlMaterial::metallic_map},
    {"map_Ps", &MtlMaterial::sheen_map},          {"map_Pc", &MtlMaterial::coat_map},
    {"map_Pcr", &MtlMaterial::coat_roughness_map}};

/// What says nothing about a path-traced picture: ambient light and its pictures, anti-aliasing,
/// sharpness of reflections.
constexpr std::string_view kMeaningless[] = {"Ka", "map_Ka", "map_aat", "sharpness"};

template <class Table>
auto find_row(const Table& table, std::string_view key) {
  return std::find_if(std::begin(table), std::end(table),
                      [&](const auto& row) { return row.first == key; });
}

void leave_out(int line, std::string_view key, std::string_view what, MtlMaterial& material) {
  material.unknown.push_back("line " + std::to_string(line) + ": " + std::string(key) +
                             (what.empty() ? "" : " ") + std::string(what));
}

/// Numbers and words of a classic material. Null where it was read; `known` is false for others.
const char* read_classic(std::string_view key, std::string_view rest, int line,
                         MtlMaterial& material, bool& known) {
  float number = 0.0F;
  known = true;
  if (key == "Ke") {
    const char* wrong = read_color(rest, material.emission);
    material.emission = glm::max(material.emission, Rgb(0.0F));
    return wrong;
  }
  if (key == "d" || key == "Tr") {
    if (rest.starts_with("-halo")) leave_out(line, key, next_word(rest), material);
    if (read_numbers(rest, {&number, 1}) != 1) return "expected a finite number";
    const float there = key == "d" ? number : 1.0F - number;
    material.dissolve = std::clamp(there, 0.0F, 1.0F);
    return nullptr;
  }
  if (key == "Ni" || key == "Ns" || key == "illum") {
    if (read_numbers(rest, {&number, 1}) != 1) return "expected a finite number";
    if (key == "Ni") material.index = std::clamp(number, 0.01F, 100.0F);
    if (key == "Ns") material.exponent = std::clamp(number, 0.0F, 1e6F);
    if (key == "illum") material.illumination = static_cast<int>(std::clamp(number, 0.0F, 99.0F));
    return nullptr;
  }
  known = false;
  return nullptr;
}

/// One line of a material. Null, or what was expected.
const char* read_line(std::string_view key, std::string_view rest, int line,
                      MtlMaterial& material) {
  if (const auto* row = find_row(kColors, key); row != std::end(kColors)) {
    if (rest.starts_with("spectral") || rest.starts_with("xyz")) {
      leave_out(line, key, next_word(rest), material);
      return nullptr;
    }
    Rgb color;
    if (const char* wrong = read_color(rest, color)) return wrong;
    material.*row->second = glm::clamp(color, 0.0F, 1.0F);
    if (max_component(color) > 1.0F) leave_out(line, key, "above 1", material);
    return nullptr;
  }
  if (const auto* row = find_row(kShares, key); row != std::end(kShares)) {
    float number = 0.0F;
    if (read_numbers(rest, {&number, 1}) != 1) return "expected a finite number";
    material.*row->second = std::clamp(number, 0.0F, 1.0F);
    return nullptr;
  }
  if (const auto* row = find_row(kMaps, key); row != std::end(kMaps)) {
    MtlMap& map = material.*row->second;
    std::vector<std::string> left_out;
    const char* wrong = read_mtl_map(rest, map, left_out);
    for (const std::string& option : left_out) leave_out(line, key, option, material);
    const bool relief = &map == &material.bump_map || &map == &material.normal_map;
    if (map.strength != 1.0F && !relief) leave_out(line, key, "-bm", material);
    return wrong;
  }
  bool known = false;
  if (const char* wrong = read_classic(key, rest, line, material, known); known) return wrong;
  if (std::find(std::begin(kMeaningless), std::end(kMeaningless), key) == std::end(kMeaningless)) {
    leave_out(line, key.substr(0, 40), {}, material);
  }
  return nullptr;
}

}  // namespace

bool MtlMaterial::physical() const {
  return roughness || metallic || sheen || coat || anisotropy || roughness_map.given() ||
         metallic_map.given() || sheen_map.given() || coat_map.given();
}

Result<std::vector<MtlMaterial>> parse_mtl(std::string_view text) {
  std::vector<MtlMaterial> materials;
  std::map<std::string, size_t> places;
  MtlMaterial* material = nullptr;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (rest.empty() || rest.front() == '#') continue;
    const std::string_view key = next_word(rest);
    const auto wrong = [&](const char* expected) {
      return Error{std::string(key.substr(0, 40)) + ": " + expected}.in("line " +
                                                                        std::to_string(number));
    };
    if (key == "newmtl") {
      const auto [place, fresh] = places.emplace(std::string(rest), materials.size());
      if (fresh) materials.emplace_back();
      material = &materials[place->second];
      *material = {};
      if (!fresh) leave_out(number, "newmtl", "of this name before", *material);
      material->name = std::string(rest);
      material->line = number;
    } else if (material != nullptr) {
      if (const char* expected = read_line(key, rest, number, *material)) return wrong(expected);
    }
  }
  return materials;
}

}  // namespace hyades::core
