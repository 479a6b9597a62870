#include "core/job/scene_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "core/base/text.h"
#include "core/job/output_path.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

constexpr std::string_view kScript = ".lua";
constexpr std::array<std::string_view, 6> kExtensions = {".glb", ".gltf", ".pbrt",
                                                         ".obj", ".ply",  kScript};
constexpr std::string_view kSetting = "set.";
constexpr size_t kLongestSetting = 64;
constexpr std::string_view kName = "scene";
constexpr std::string_view kEnd = ".yaml";

/// Text as part of a file's name: what is neither letter, digit nor one of _-. is %XX.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || c == '_' || c == '-' || c == '.') {
      out += c;
    } else {
      out += fmt::format("%{:02X}", u);
    }
  }
  return out;
}

/// Escapes have one spelling, in capitals, so that a document has one name.
std::optional<std::string> unescaped(std::string_view text) {
  for (size_t at = 0; (at = text.find('%', at)) != std::string_view::npos; ++at) {
    if (text.substr(at + 1, 2).find_first_of("abcdef") != std::string_view::npos) {
      return std::nullopt;
    }
  }
  return percent_decoded(text);
}

/// Takes one ",key=value" in. False: it says nothing that is known.
bool read_option(std::string_view option, SceneDocument& document) {
  const size_t equals = option.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string_view key = option.substr(0, equals);
  const auto value = unescaped(option.substr(equals + 1));
  if (!value) return false;
  if (key == "prefix") {
    document.prefix = *value;
  } else if (key == "animation") {
    document.animation = *value;
  } else if (key == "loop") {
    if (*value != "true") return false;
    document.loop = true;
  } else if (key == "frames") {
    document.frames = *value;
  } else if (key.starts_with(kSetting) && is_setting_name(key.substr(kSetting.size()))) {
    document.set.emplace_back(key.substr(kSetting.size()), *value);
  } else if (key == "fps") {
    double fps = 0.0;
    const bool script = is_script_file(document.scene);
    if (!parse_number(*value, fps) || !(fps >= 0.0 && fps <= 1e6)) return false;
    if (fps == 0.0 && !script) return false;
    document.fps = static_cast<float>(fps);
  } else {
    return false;
  }
  return true;
}

/// Takes ",key=value,key=value" in. False: it says something that is not known.
bool read_options(std::string_view options, SceneDocument& document) {
  while (!options.empty()) {
    if (options.front() != ',') return false;
    options.remove_prefix(1);
    const size_t end = std::min(options.find(','), options.size());
    if (!read_option(options.substr(0, end), document)) return false;
    options.remove_prefix(end);
  }
  return true;
}

/// The document of a script, which lies beside it; `name` is without its end.
std::optional<SceneDocument> script_document_of(std::string_view name) {
  for (size_t comma = name.find(','); comma < name.size(); comma = name.find(',', comma + 1)) {
    SceneDocument document;
    document.scene = name.substr(0, comma);
    document.fps = 0.0F;
    if (is_script_file(document.scene) && read_options(name.substr(comma), document)) {
      return document;
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_scene_file(std::string_view name) {
  const std::string extension = file_extension(std::string(name));
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::string scene_file_ends() { return fmt::format("{}", fmt::join(kExtensions, ", ")); }

std::string hint_for_scene_file(std::string_view name) {
  constexpr std::array<std::string_view, 8> kOnlyBlenders = {".fbx", ".dae",  ".abc",  ".stl",
                                                             ".usd", ".usda", ".usdc", ".usdz"};
  const std::string extension = file_extension(std::string(name));
  const bool known =
      std::find(kOnlyBlenders.begin(), kOnlyBlenders.end(), extension) != kOnlyBlenders.end();
  return known ? ": Blender opens it, and writes .glb" : "";
}

bool is_script_file(std::string_view name) { return file_extension(std::string(name)) == kScript; }

bool is_setting_name(std::string_view name) {
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  return !name.empty() && name.size() <= kLongestSetting &&
         std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), is_letter);
}

std::string reference_of(const SceneDocument& document) {
  const bool script = is_script_file(document.scene);
  std::string name = document.scene;
  if (!script) name += fmt::format("{}/{}", kMadeFolder, kName);
  if (!document.prefix.empty()) name += ",prefix=" + escaped(document.prefix);
  if (document.fps > 0.0F || script) name += fmt::format(",fps={}", document.fps);
  if (!document.animation.empty()) name += ",animation=" + escaped(document.animation);
  if (document.loop) name += ",loop=true";
  if (!document.frames.empty()) name += ",frames=" + escaped(document.frames);
  for (const auto& [key, value] : document.set) {
    name += fmt::format(",{}{}={}", kSetting, key, escaped(value));
  }
  return name + std::string(kEnd);
}

std::optional<SceneDocument> document_of(std::string_view reference) {
  if (!reference.ends_with(kEnd)) return std::nullopt;
  if (auto script = script_document_of(reference.substr(0, reference.size() - kEnd.size()))) {
    return script;
  }
  const size_t slash = reference.rfind('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view folder = reference.substr(0, slash);
  std::string_view name = reference.substr(slash + 1);
  name.remove_suffix(kEnd.size());
  if (!folder.ends_with(kMadeFolder) || !name.starts_with(kName)) return std::nullopt;
  SceneDocument document;
  document.scene = folder.substr(0, folder.size() - kMadeFolder.size());
  name.remove_prefix(kName.size());
  if (!read_options(name, document)) return std::nullopt;
  return document;
}

}  // namespace hyades::core
