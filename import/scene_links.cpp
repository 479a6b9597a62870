#include "import/scene_links.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/base/folder_links.h"

namespace hyades::core {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUdim = "<UDIM>";

/// What a pattern is looked for by: the name before its first mark and after its last.
struct Marked {
  std::string before;
  std::string after;
};

std::optional<Marked> marked(const std::string& step) {
  const size_t udim = step.find(kUdim);
  const size_t first = std::min(udim, step.find('#'));
  if (first == std::string::npos) return std::nullopt;
  const size_t after_frame = step.rfind('#') + 1;  // 0: there is none
  const size_t after_tile = udim == std::string::npos ? 0 : step.rfind(kUdim) + kUdim.size();
  return Marked{step.substr(0, first), step.substr(std::max(after_frame, after_tile))};
}

/// Whether the system finds what nobody can tell the way to: what a name stands for may be longer
/// than any name, or have no name any more (/proc).
bool opens(const fs::path& path) {
  std::error_code none;
  return fs::exists(path, none);
}

Error unknown(const std::string& file, const std::string& way, const std::error_code& why) {
  return Error{
      file + ": whether it lies in the scene's folder cannot be told: " + way.substr(0, 200) +
      ": " + why.message() + "; say --follow-links if you trust where the scene comes from"};
}

/// What it costs to follow the links of a path, in entries of a folder that could be looked at
/// meanwhile: each step is looked up from the first on.
int64_t cost_of(const std::string& path) {
  const int64_t steps = 1 + std::count(path.begin(), path.end(), '/');
  return steps * steps / 16;
}

/// All that a name may mean, one after the other: links within a folder may lead back into it, over
/// and over, so that there may be any number.
class Meant {
 public:
  using Visit = std::function<Status(const std::string&)>;

  Meant(fs::path folder, const std::string& file, std::atomic<int64_t>& left, Visit visit)
      : folder_(std::move(folder)), file_(file), left_(left), visit_(std::move(visit)) {
    for (const fs::path& step : fs::path(file)) steps_.push_back(step.string());
  }

  Status all() { return follow({}, 0); }

 private:
  Status follow(const std::string& way, size_t i) {
    if (way.size() > kLongestFileName) return {};  // no system opens it
    if (i == steps_.size()) return spend(cost_of(way)) ? visit_(way) : too_many();
    const std::string& step = steps_[i];
    if (auto done = follow((fs::path(way) / step).string(), i + 1); !done) return done;
    const auto pattern = marked(step);
    if (!pattern) return {};
    std::vector<std::string> names;
    if (auto found = find(way, *pattern, names); !found) return found;
    for (const std::string& name : names) {
      if (auto done = follow((fs::path(way) / name).string(), i + 1); !done) return done;
    }
    return {};
  }

  /// The entries of the folder `way` that `pattern` means.
  Status find(const std::string& way, const Marked& pattern, std::vector<std::string>& names) {
    constexpr int64_t kCostOfOne = 64;  // to be followed
    if (!spend(kCostOfOne + cost_of(way))) return too_many();
    std::error_code failed;
    fs::directory_iterator entries(folder_ / way, failed);
    for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
      std::string name = entries->path().filename().string();
      const bool meant = name.starts_with(pattern.before) && name.ends_with(pattern.after);
      if (!spend(meant ? kCostOfOne : 1)) return too_many();
      if (meant) names.push_back(std::move(name));
    }
    // One that may not be listed may have links that are opened by their names.
    if (failed && !is_not_there(failed) && opens(folder_ / way)) {
      // Linux may count the links of a way twice where others rename files meanwhile.
      if (failed != std::errc::too_many_symbolic_link_levels) return unknown(file_, way, failed);
      left_ = 0;
      return too_many();
    }
    return {};
  }

  bool spend(int64_t cost) { return cost == 0 || (left_ -= cost) > 0; }

  Status too_many() const {
    return Error{file_ +
                 ": the names of this scene, and of those before it, that have marks "
                 "('####', '<UDIM>') or many steps may mean too many files, expected fewer "
                 "of them, or folders of fewer files"};
  }

  const fs::path folder_;
  const std::string& file_;
  std::atomic<int64_t>& left_;
  const Visit visit_;
  std::vector<std::string> steps_;
};

}  // namespace

Status SceneLinks::check_one(const std::string& base, const std::string& file) const {
  std::error_code failed;
  const fs::path start = fs::path(folder_) / base;
  const fs::path home = fs::canonical(start.empty() ? "." : start, failed);
  if (failed) {
    return opens(start.empty() ? "." : start) ? unknown(file, start.string(), failed) : Status{};
  }
  const fs::path target = fs::canonical(fs::path(folder_) / file, failed);
  if (failed) return opens(fs::path(folder_) / file) ? unknown(file, file, failed) : Status{};
  if (is_inside(target, home)) return {};
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
  if (file.size() > kLongestFileName) {
    return Error{file.substr(0, 60) + "...: a name of " + std::to_string(file.size()) +
                 " bytes, expected at most " + std::to_string(kLongestFileName)};
  }
  const std::string base = fs::path(scene).parent_path().string();
  return Meant(fs::path(folder_), file, *left_,
               [&](const std::string& each) { return check_one(base, each); })
      .all();
}

}  // namespace hyades::core
