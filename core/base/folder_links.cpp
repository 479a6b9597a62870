#include "core/base/folder_links.h"

#include <algorithm>

namespace hyades::core {

namespace fs = std::filesystem;

bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

bool is_not_there(const std::error_code& error) {
  return error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
}

FolderLinks::FolderLinks(const std::string& folder)
    : start_(fs::path(folder.empty() ? "." : folder).lexically_normal()) {
  home_ = fs::canonical(start_, failed_);
}

Status FolderLinks::check(const std::string& path) {
  const fs::path below = fs::path(path).lexically_normal().lexically_relative(start_);
  if (below.empty() || *below.begin() == "..") return {};
  if (failed_) {
    if (is_not_there(failed_)) return {};
    // A name may lead through links to where no name is long enough.
    return Error{start_.string().substr(0, 200) + ": what is in this folder cannot be told (" +
                 failed_.message() + "); expected another one (--output)"};
  }
  fs::path way = start_;
  for (const fs::path& step : below.parent_path()) {
    way /= step;
    if (!known_.insert(way.string()).second) continue;
    if (auto stays = check_step(way); !stays) {
      known_.erase(way.string());
      return stays;
    }
  }
  return check_step(way / below.filename());
}

Status FolderLinks::check_step(const fs::path& way) const {
  std::error_code failed;
  if (fs::symlink_status(way, failed).type() != fs::file_type::symlink) return {};
  const fs::path target = fs::canonical(way, failed);
  if (!failed && is_inside(target, home_)) return {};
  return Error{way.string() +
               ": a link that leads out of the folder that is written to; remove "
               "it, or write to another folder (--output)"};
}

Status stays_in_folder(const std::string& folder, const std::string& path) {
  return FolderLinks(folder).check(path);
}

}  // namespace hyades::core
