#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <system_error>

#include "core/base/result.h"

namespace hyades::core {

/// Whether `path` is `folder` or lies below it; both canonical.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Whether the error says that there is no such file or folder, and not that nobody can tell.
bool is_not_there(const std::error_code& error);

/// Looks whether files that are to be written stay in a folder. Folders come from others, as scenes
/// do; the folder itself may be a link, for who names it means it.
class FolderLinks {
 public:
  explicit FolderLinks(const std::string& folder);

  /// An error where a link of the disk would lead `path`, below the folder, out of it, or to nobody
  /// knows where. Paths that do not begin with the folder are none of its business.
  Status check(const std::string& path);

 private:
  Status check_step(const std::filesystem::path& way) const;

  std::filesystem::path start_;
  std::filesystem::path home_;   ///< canonical; empty: it is not there yet, and so has no links
  std::error_code failed_;       ///< of finding home_
  std::set<std::string> known_;  ///< folders on the way to files that have been looked at
};

/// FolderLinks::check() of a single file.
Status stays_in_folder(const std::string& folder, const std::string& path);

}  // namespace hyades::core
