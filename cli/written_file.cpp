#include "cli/written_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>

#include "core/base/printable.h"

namespace hyades::cli {

namespace {

std::string wrong_folder(const std::string& path) {
  constexpr std::array<std::string_view, 7> kPictures = {".png", ".exr", ".jpg", ".jpeg",
                                                         ".tif", ".mp4", ".tiff"};
  std::error_code none;
  const bool is_picture = std::any_of(kPictures.begin(), kPictures.end(), [&](auto ending) {
    return path.size() > ending.size() && path.ends_with(ending);
  });
  if (!is_picture || std::filesystem::is_directory(path, none)) return {};
  return path + ": expected a folder; what files are called there the job's 'outputs' say";
}

}  // namespace

void declare_output_folder(CLI::App& app, std::string& folder, const std::string& description) {
  app.add_option("-o,--output", folder, description)
      ->check(wrong_folder)
      ->capture_default_str()
      ->type_name("DIR");
}

core::Status WrittenFile::check(const std::string& path) const {
  std::error_code none;
  const bool is_plain = std::filesystem::is_regular_file(path, none);
  const bool leads_nowhere =
      std::filesystem::is_symlink(path, none) && !std::filesystem::exists(path, none);
  // What is no plain file, /dev/stdout say, is not replaced.
  if (overwrite || (!is_plain && !leads_nowhere)) return {};
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
