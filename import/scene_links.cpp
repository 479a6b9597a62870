#include "import/scene_links.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace hyades::core {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUdim = "<UDIM>";

/// Whether `path` lies in `folder` or below it; both canonical.
bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// Adds the ways that `way` has with one more step, which may be a pattern; as written too. What a
/// pattern costs is taken from `left`; false where that does not suffice.
bool add_meant(const fs::path& folder, const fs::path& way, const std::string& step,
               std::atomic<int64_t>& left, std::vector<fs::path>& ways) {
  constexpr int64_t kCostOfMeant = 16;  // entries that could be looked at while one is followed
  ways.push_back(way / step);
  const size_t udim = step.find(kUdim);
  const size_t first = std::min(udim, step.find('#'));
  if (first == std::string::npos) return true;
  left -= kCostOfMeant;
  const size_t after_frame = step.rfind('#') + 1;  // 0: there is none
  const size_t after_tile = udim == std::string::npos ? 0 : step.rfind(kUdim) + kUdim.size();
  const std::string_view before = std::string_view(step).substr(0, first);
  const std::string_view after = std::string_view(step).substr(std::max(after_frame, after_tile));
  std::error_code failed;
  fs::directory_iterator entries(folder / way, failed);
  for (; !failed && entries != fs::directory_iterator() && --left > 0; entries.increment(failed)) {
    const std::string name = entries->path().filename().string();
    if (!name.starts_with(before) || !name.ends_with(after)) continue;
    ways.push_back(way / name);
    left -= kCostOfMeant;
  }
  return left > 0;
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
  if (!left_) return {};
  const std::string base = fs::path(scene).parent_path().string();
  std::vector<fs::path> meant = {fs::path()};
  for (const fs::path& step : fs::path(file)) {
    std::vector<fs::path> longer;
    for (const fs::path& way : meant) {
      if (add_meant(fs::path(folder_), way, step.string(), *left_, longer)) continue;
      return Error{file +
                   ": the names with marks ('####', '<UDIM>') of this scene and those before "
                   "it may mean too many files, expected fewer of them, or folders of fewer files"};
    }
    meant = std::move(longer);
  }
  for (const fs::path& each : meant) {
    if (auto inside = check_one(base, each.string()); !inside) return inside;
  }
  return {};
}

}  // namespace hyades::core
