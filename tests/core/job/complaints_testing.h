#pragma once

#include <string>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

/// The exact text of every kind of complaint: file, line, column, what was found, what was
/// expected.
namespace hyades::core {

inline std::string complaints(const std::string& body) {
  MemoryAssets assets;
  assets.add("a.obj", "mesh");
  Diagnostics diagnostics;
  parse_job("hyades: 1\n" + body, "job.yaml", assets, diagnostics);
  return diagnostics.to_string();
}

}  // namespace hyades::core
