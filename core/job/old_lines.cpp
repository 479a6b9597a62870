#include "core/job/old_lines.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace hyades::core {
namespace {

bool is_of(const OldLine& old, const FieldWriter::Line& line) {
  const std::string_view key = old.key;
  if (old.beside != nullptr && line.key == old.beside) return true;
  return key.ends_with('*') ? line.key.starts_with(key.substr(0, key.size() - 1)) : line.key == key;
}

}  // namespace

void write_in_old_order(FieldWriter& out, std::span<const OldLine> old,
                        const std::vector<FieldWriter::Line>& lines,
                        const std::function<std::vector<FieldWriter::Line>()>& defaults) {
  std::vector<bool> is_old(lines.size(), false);
  for (const OldLine& row : old) {
    bool there = false;
    for (size_t i = 0; i < lines.size(); ++i) {
      if (is_old[i] || !is_of(row, lines[i])) continue;
      there = is_old[i] = true;
      if (row.left_out == nullptr || lines[i].value != row.left_out) {
        out.line(lines[i].key, lines[i].value);
      }
    }
    if (!there && row.absent != nullptr) out.line(row.key, row.absent);
  }
  if (std::find(is_old.begin(), is_old.end(), false) == is_old.end()) return;
  const std::vector<FieldWriter::Line> usual = defaults();
  for (size_t i = 0; i < lines.size(); ++i) {
    const bool changed = std::find(usual.begin(), usual.end(), lines[i]) == usual.end();
    if (!is_old[i] && changed) out.line(lines[i].key, lines[i].value);
  }
}

}  // namespace hyades::core
