#pragma once

#include <string>

#include "core/base/result.h"

namespace CLI {
class App;
}

namespace hyades::cli {

/// How a command treats the file that it writes.
struct WrittenFile {
  bool overwrite = false;
  bool quiet = false;

  /// An error where `path` is there and may not be replaced.
  core::Status check(const std::string& path) const;

  /// "wrote PATH" on standard error, where that is to be said.
  void tell(const std::string& path) const;
};

/// Option -o of a command that writes into a folder. The name of a picture is refused, which people
/// say who want one.
void declare_output_folder(CLI::App& app, std::string& folder,
                           const std::string& description = "folder for what is written");

/// Options --overwrite and -q.
void declare_written_file(CLI::App& app, WrittenFile& written);

}  // namespace hyades::cli
