#pragma once

#include <optional>
#include <string>

#include "core/job/scene_document.h"
#include "core/job/source.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// A script that a job includes, and its parameters.
struct ScriptInclude {
  std::string scene;
  ScriptSettings set;
};

/// Reads `{lua: city.lua, set: {seed: 3}}`, one item of `include:`. Nothing after a complaint: keys
/// that are not known, a file that is no script, settings that are no plain values or too long.
std::optional<ScriptInclude> read_script_include(const YamlNode& node, Diagnostics& diagnostics);

/// What is wrong with a setting; empty where nothing is. Its value: at most 100 characters, so that
/// it can stand in the name of the script's document.
std::string wrong_setting(const std::string& name, const std::string& value);

}  // namespace hyades::core
