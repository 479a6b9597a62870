#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hyades::test {

/// Path of a file of the shared assets, which are not part of the repository: below the folder
/// named by HYADES_SHARED, or beside the source tree (tests run in its root). Tests skip visibly
/// where it does not exist.
inline std::string shared_file(const std::string& name) {
  const char* folder = std::getenv("HYADES_SHARED");
  return (std::filesystem::path(folder != nullptr ? folder : "../shared") / name).string();
}

}  // namespace hyades::test

/// Skips the current test, visibly, where `path` does not exist.
#define HYADES_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not here: " << (path)
