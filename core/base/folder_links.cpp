#include "core/base/folder_links.h"

#include <algorithm>
#include <system_error>

namespace hyades::core {

namespace fs = std::filesystem;

bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

Status stays_in_folder(const std::string& folder, const std::string& path) {
  const fs::path start = fs::path(folder.empty() ? "." : folder).lexically_normal();
  const fs::path below = fs::path(path).lexically_normal().lexically_relative(start);
  if (below.empty() || *below.begin() == "..") return {};
  std::error_code failed;
  const fs::path home = fs::canonical(start, failed);
  if (failed) return {};  // it is made, and is empty
  fs::path way = start;
  for (const fs::path& step : below) {
    way /= step;
    const fs::file_status found = fs::symlink_status(way, failed);
    if (found.type() == fs::file_type::not_found) return {};
    if (found.type() != fs::file_type::symlink) continue;
    const fs::path target = fs::canonical(way, failed);
    if (!failed && is_inside(target, home)) continue;
    return Error{way.string() +
                 ": a link that leads out of the folder that is written to; remove "
                 "it, or write to another folder (--output)"};
  }
  return {};
}

}  // namespace hyades::core
