#include "core/job/made_lines.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>

#include "core/base/assets.h"
#include "core/job/scene_document.h"

namespace hyades::core {

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
  const std::string other = resolve_reference(std::string(mark.substr(1)), *file_);
  const bool same = !marks_.empty() && *marks_.back().where.file == other;
  return {same ? marks_.back().where.file : std::make_shared<const std::string>(other), line, 0};
}

std::set<std::string> MadeLines::other_files() const {
  std::set<std::string> files;
  for (const Mark& mark : marks_) {
    if (mark.where.file != file_) files.insert(*mark.where.file);
  }
  return files;
}

YamlPlace MadeLines::at(int line, int column) const {
  if (!made_) return {file_, line, column};
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), line,
                                      [](int wanted, const Mark& m) { return wanted < m.from; });
  return after == marks_.begin() ? YamlPlace{file_, 0, 0} : std::prev(after)->where;
}

}  // namespace hyades::core
