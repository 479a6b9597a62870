#include "cli/mtl_file.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/geometry/text_scanner.h"

namespace hyades::cli {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && core::is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && core::is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Reads finite numbers into `out`; how many there were, or -1 where something else stands there.
int read_numbers(std::string_view text, std::span<float> out) {
  const char* at = text.data();
  const char* const end = at + text.size();
  int count = 0;
  while (static_cast<size_t>(count) < out.size()) {
    while (at < end && core::is_space(*at)) ++at;
    if (at == end || *at == '#') break;
    float& number = out[static_cast<size_t>(count)];
    at = core::scan_float(at, end, number);
    if (at == nullptr || !std::isfinite(number)) return -1;
    ++count;
  }
  return count;
}

/// A colour: three numbers, or one for all channels.
bool read_color(std::string_view text, core::Rgb& color) {
  float parts[3] = {};
  const int count = read_numbers(text, parts);
  if (count != 1 && count != 3) return false;
  color = count == 1 ? core::Rgb(parts[0]) : core::Rgb(parts[0], parts[1], parts[2]);
  return true;
}

/// Null, or what was expected.
const char* read_line(std::string_view key, std::string_view rest, MtlMaterial& material) {
  float number = 0.0F;
  core::Rgb color;
  if (key == "Kd" || key == "Ke") {
    if (rest.starts_with("spectral") || rest.starts_with("xyz")) return nullptr;
    if (!read_color(rest, color)) return "expected 'Kd r g b' or 'Ke r g b', finite numbers";
    if (key == "Kd") material.diffuse = glm::clamp(color, 0.0F, 1.0F);
    if (key == "Ke") material.emission = glm::max(color, core::Rgb(0.0F));
  } else if (key == "Ni") {
    if (read_numbers(rest, {&number, 1}) != 1) return "expected 'Ni n', a finite number";
    material.index = std::clamp(number, 0.01F, 100.0F);
  } else if (key == "d" || key == "Tr") {
    if (rest.starts_with("-halo")) return nullptr;
    if (read_numbers(rest, {&number, 1}) != 1) return "expected 'd x' or 'Tr x', a finite number";
    material.clear = key == "d" ? number < 1.0F : number > 0.0F;
  }
  return nullptr;
}

}  // namespace

core::Result<std::map<std::string, MtlMaterial>> parse_mtl(std::string_view text) {
  std::map<std::string, MtlMaterial> materials;
  MtlMaterial* material = nullptr;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const size_t blank = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view key = line.substr(0, blank);
    const std::string_view rest = trimmed(line.substr(blank));
    if (key == "newmtl") {
      material = &materials[std::string(rest)];
    } else if (material != nullptr) {
      if (const char* wrong = read_line(key, rest, *material)) {
        return core::Error{wrong}.in("line " + std::to_string(number));
      }
    }
  }
  return materials;
}

}  // namespace hyades::cli
