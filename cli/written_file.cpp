#include "cli/written_file.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>

#include "core/base/printable.h"

namespace hyades::cli {

core::Status WrittenFile::check(const std::string& path) const {
  std::error_code none;
  // What is no plain file, /dev/stdout say, is not replaced.
  if (overwrite || !std::filesystem::is_regular_file(path, none)) return {};
  return core::Error{path + " is there already (--overwrite replaces it)"};
}

void WrittenFile::tell(const std::string& path) const {
  if (!quiet) std::fprintf(stderr, "wrote %s\n", core::printable(path).c_str());
}

void declare_written_file(CLI::App& app, WrittenFile& written) {
  app.add_flag("--overwrite", written.overwrite, "replace a file that is there");
  app.add_flag("-q,--quiet", written.quiet, "say nothing where all goes well");
}

}  // namespace hyades::cli
