#include "core/job/source.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "core/base/printable.h"
#include "core/job/scene_document.h"

namespace hyades::core {

namespace {

constexpr size_t kMaxDiagnostics = 100;

}  // namespace

std::string Diagnostic::to_string() const {
  std::string text = where.file;
  if (where.line > 0) {
    text += ":" + std::to_string(where.line);
    if (where.column > 0) text += ":" + std::to_string(where.column);
  }
  return text.empty() ? message : text + ": " + message;
}

void Diagnostics::add(const SourceLocation& place, std::string message) {
  if (full()) return;
  SourceLocation where = place;
  // What importers make of a scene has lines, but nobody sees them. Those of scripts are told.
  if (is_scene_file(where.file) && !is_script_file(where.file)) where = {where.file, 0, 0};
  if (list_.size() == kMaxDiagnostics) {
    message = "too many complaints: only the first " + std::to_string(kMaxDiagnostics) +
              " are listed, mend those and look again";
    list_.push_back({SourceLocation{where.file, 0, 0}, std::move(message)});
    return;
  }
  list_.push_back({where, std::move(message)});
}

bool Diagnostics::full() const { return list_.size() > kMaxDiagnostics; }

std::string Diagnostics::to_string() const {
  std::vector<const Diagnostic*> order;
  for (const Diagnostic& d : list_) order.push_back(&d);
  // The closing "too many" carries no line and stays last.
  const bool cut = full();
  std::stable_sort(order.begin(), order.end() - (cut ? 1 : 0), [](const auto* a, const auto* b) {
    return std::tie(a->where.file, a->where.line, a->where.column) <
           std::tie(b->where.file, b->where.line, b->where.column);
  });
  std::string text;
  for (const Diagnostic* d : order) text += d->to_string() + "\n";
  return printable_lines(text);  // a stranger may have written the job
}

Error Diagnostics::to_error() const {
  std::string text = to_string();
  if (!text.empty()) text.pop_back();
  return Error{std::move(text)};
}

}  // namespace hyades::core
