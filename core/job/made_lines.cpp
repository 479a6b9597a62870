#include "core/job/made_lines.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <utility>

#include "core/base/assets.h"
#include "core/job/scene_document.h"

namespace hyades::core {

namespace {

constexpr size_t kMostOthers = 256;

/// Whether a script may speak for the file: scripts include others of their folder alone.
bool is_beside(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  return !path.is_absolute() && !path.empty() && *path.begin() != "..";
}

}  // namespace

MadeLines::MadeLines(std::string_view text, const std::string& file)
    : file_(std::make_shared<const std::string>(file)), made_(is_script_file(file)) {
  if (!made_) return;
  int line = 1;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, end);
    ++line;
    if (whole.starts_with(kLineMark)) {
      marks_.push_back({line, place_of(whole.substr(kLineMark.size()))});
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

YamlPlace MadeLines::place_of(std::string_view mark) {
  int line = 0;
  const auto read = std::from_chars(mark.data(), mark.data() + mark.size(), line);
  mark.remove_prefix(static_cast<size_t>(read.ptr - mark.data()));
  if (mark.size() < 2) return {file_, line, 0};
  mark.remove_prefix(1);
  auto other = others_.find(mark);
  if (other == others_.end()) {
    const std::string name(mark);
    if (others_.size() >= kMostOthers || !is_beside(name)) return {file_, line, 0};
    auto path = std::make_shared<const std::string>(resolve_reference(name, *file_));
    other = others_.emplace(name, std::move(path)).first;
  }
  return {other->second, line, 0};
}

std::set<std::string> MadeLines::other_files() const {
  std::set<std::string> files;
  for (const auto& [mark, path] : others_) files.insert(*path);
  return files;
}

YamlPlace MadeLines::at(int line, int column) const {
  if (!made_) return {file_, line, column};
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), line,
                                      [](int wanted, const Mark& m) { return wanted < m.from; });
  return after == marks_.begin() ? YamlPlace{file_, 0, 0} : std::prev(after)->where;
}

}  // namespace hyades::core
