#pragma once

#include <map>
#include <string>

#include "core/job/source.h"

namespace hyades::core {

/// Who says what stands at a place of a job's text: the job, a file that it includes, or a script.
struct Origins {
  /// Name in complaints of an included file -> its path relative to the job's folder.
  std::map<std::string, std::string> included;
  /// Name in complaints of what a script says or includes -> the script, which may name files of
  /// its own folder only.
  std::map<std::string, std::string> scripts;

  /// The path of the file that says what stands at `where`; empty: the job.
  std::string file_at(const SourceLocation& where) const { return found(included, where); }
  /// The script by whose word it stands there; empty: none, by the job's.
  std::string script_at(const SourceLocation& where) const { return found(scripts, where); }

 private:
  static std::string found(const std::map<std::string, std::string>& names,
                           const SourceLocation& where) {
    const auto name = names.find(where.file);
    return name == names.end() ? std::string() : name->second;
  }
};

}  // namespace hyades::core
