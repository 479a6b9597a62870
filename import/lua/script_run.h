#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/job/scene_document.h"
#include "core/job/yaml_tree.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

/// One run of a script.
struct ScriptRequest {
  AssetResolver& files;       ///< the script and what it includes
  std::string script;         ///< as `files` know it
  const ScriptSettings& set;  ///< parameters; of several of one name the last counts
  std::string made;           ///< stands before the names of files that it makes
  int32_t frame = 1;          ///< what frame() tells
  double fps = 24.0;          ///< and time()
  Limits limits{};
};

/// A parameter that the script has asked for.
struct Parameter {
  std::string name;
  std::string usual;  ///< its default, as a person would write it
  std::string help;   ///< empty: none
};

/// What a script has said.
struct ScriptResult {
  YamlPtr tree;             ///< a map; its places name files from the script's folder on
  bool asks_frame = false;  ///< whether it has called frame() or time()
  std::vector<Parameter> parameters;
  std::map<std::string, Bytes> made;  ///< files that the tree names, without ScriptRequest::made
};

/// An error of a tree, whose places name files from the folder of `script` on, as a person knows
/// them.
Error told_beside(const std::string& script, const Error& error);

/// Runs a script: docs/lua.md tells what it finds. Errors name file and line, those of the script
/// itself with a traceback.
Result<ScriptResult> run_script(const ScriptRequest& request);

}  // namespace hyades::core::lua
