#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

/// pbrt-v4's scene files as parts of a job. See docs/import.md for what becomes of what.
namespace hyades::core::pbrt {

/// Where something stands in a scene's files; line and column count from 1.
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;

  /// "scene.pbrt:12:7"; empty where it is nowhere.
  std::string text() const;
  Error error(const std::string& what) const;
};

/// What is to be said about a scene while it is turned into a job.
struct Report {
  std::vector<std::string> notes;   ///< what has no counterpart
  std::vector<std::string> errors;  ///< what is wrong; at most kMostErrors are kept

  static constexpr size_t kMostErrors = 20;
  static constexpr size_t kMostNotes = 1000;

  void note(const Place& place, const std::string& what);
  void error(const Place& place, const std::string& what);
};

}  // namespace hyades::core::pbrt
