#include "import/scene_links.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace hyades::core {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUdim = "<UDIM>";

/// Whether `path` lies in `folder` or below it; both canonical.
bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

Status SceneLinks::check_one(const std::string& base, const std::string& file) const {
  std::error_code failed;
  const fs::path start = fs::path(folder_) / base;
  const fs::path home = fs::canonical(start.empty() ? "." : start, failed);
  if (failed) return {};
  const fs::path target = fs::canonical(fs::path(folder_) / file, failed);
  if (failed || is_inside(target, home)) return {};
  // The first link on the way that leads out is the one to tell.
  fs::path way = start;
  for (const fs::path& step : fs::path(file).lexically_relative(base.empty() ? "." : base)) {
    way /= step;
    const bool is_link = fs::is_symlink(way, failed);
    if (is_link && !is_inside(fs::canonical(way, failed), home)) break;
  }
  return Error{file + ": leads out of the scene's folder, by the link " + way.string() +
               "; copy what it stands for into the folder, or say --follow-links if you trust "
               "where the scene comes from"};
}

Status SceneLinks::check(const std::string& scene, const std::string& file) const {
  if (!looked_at_) return {};
  const std::string base = fs::path(scene).parent_path().string();
  const fs::path whole(file);
  const std::string name = whole.filename().string();
  const size_t udim = name.find(kUdim);
  const size_t first = std::min(udim, name.find('#'));
  if (first == std::string::npos) return check_one(base, file);
  const size_t last = udim != std::string::npos ? udim + kUdim.size() : name.rfind('#') + 1;
  const std::string_view before = std::string_view(name).substr(0, first);
  const std::string_view after = std::string_view(name).substr(last);
  const fs::path parent = whole.parent_path();
  std::error_code failed;
  fs::directory_iterator entries(fs::path(folder_) / parent, failed);
  for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
    const std::string each = entries->path().filename().string();
    if (!each.starts_with(before) || !each.ends_with(after)) continue;
    if (auto inside = check_one(base, (parent / each).string()); !inside) return inside;
  }
  return {};
}

}  // namespace hyades::core
