#pragma once

#include <string>

#include "core/job/parse.h"
#include "core/job/yaml_writer.h"
#include "import/importing_resolver.h"
#include "import/lua/script_run.h"
#include "tests/core/job/test_assets.h"

namespace hyades::test {

/// What one run of a script says: its tree as YAML in one text, or the error.
struct LuaSays {
  std::string yaml;
  std::string error;
};

/// Runs `script` as a/scene.lua, with `files` beside it.
inline LuaSays run_lua(const std::string& script, const core::ScriptSettings& set = {},
                       const core::lua::Limits& limits = {}, core::MemoryAssets files = {}) {
  files.add("a/scene.lua", script);
  core::lua::ScriptRequest request{files, "a/scene.lua", set, "scene.lua.files/"};
  request.limits = limits;
  const auto result = core::lua::run_script(request);
  if (!result) return {"", result.error().message};
  return {core::write_yaml(*result->tree), ""};
}

/// What `v` is where the script ends with `return {v = v}`.
inline std::string lua_value(const std::string& script) {
  const LuaSays says = run_lua(script + "\nreturn {v = v}");
  return says.error.empty() ? says.yaml : "ERROR " + says.error;
}

/// The complaints about the job `job` (job.yaml), where `files` are beside it.
inline std::string job_complaints(const std::string& job, core::MemoryAssets files,
                                  core::Job* parsed = nullptr) {
  core::ImportingResolver importing(files);
  core::Diagnostics diagnostics;
  core::Job read = core::parse_job("hyades: 1\n" + job, "job.yaml", importing, diagnostics);
  if (parsed != nullptr) *parsed = std::move(read);
  return diagnostics.to_string();
}

}  // namespace hyades::test
