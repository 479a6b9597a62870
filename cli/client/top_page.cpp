#include "cli/client/top_page.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "cli/client/show.h"
#include "core/base/printable.h"
#include "core/base/text.h"

namespace hyades::cli {
namespace {

enum class Style { plain, head, good, busy, bad, faint };

const char* code_of(Style style) {
  switch (style) {
    case Style::plain:
      return "";
    case Style::head:
      return "\033[7m";
    case Style::good:
      return "\033[32m";
    case Style::busy:
      return "\033[33m";
    case Style::bad:
      return "\033[31m";
    case Style::faint:
      return "\033[2m";
  }
  return "";
}

struct Cell {
  std::string text;
  Style style = Style::plain;
};

struct Column {
  const char* title;
  int width;  ///< columns; negative: to the right
};

/// The first `columns` columns of a text, filled up with blanks.
std::string fit(const std::string& text, int columns, bool right) {
  std::string cut;
  int used = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
    if (begins && used == columns) break;
    used += begins ? 1 : 0;
    cut += text[i];
  }
  const std::string blanks(static_cast<size_t>(columns - used), ' ');
  return right ? blanks + cut : cut + blanks;
}

/// Rows of cells as lines.
class Page {
 public:
  Page(int width, int height, bool colors) : width_(width), height_(height), colors_(colors) {}

  void line(const std::string& text, Style style = Style::plain) {
    lines_.push_back(dress(fit(text, width_, false), style));
  }
  void row(const std::vector<Column>& columns, const std::vector<Cell>& cells) {
    std::string line;
    int left = width_;
    for (size_t i = 0; i < columns.size() && left > 0; ++i) {
      const int width = std::min(std::abs(columns[i].width), left);
      line += dress(fit(cells[i].text, width, columns[i].width < 0), cells[i].style);
      left -= width;
      if (left > 0 && i + 1 < columns.size()) {
        line += ' ';
        --left;
      }
    }
    lines_.push_back(line + std::string(static_cast<size_t>(std::max(left, 0)), ' '));
  }
  void head(const std::vector<Column>& columns) {
    std::string titles;
    for (const Column& column : columns) {
      titles +=
          (titles.empty() ? "" : " ") + fit(column.title, std::abs(column.width), column.width < 0);
    }
    line(titles, Style::head);
  }
  int room() const { return height_ - static_cast<int>(lines_.size()); }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::string dress(const std::string& text, Style style) const {
    return colors_ && style != Style::plain ? code_of(style) + text + "\033[0m" : text;
  }
  int width_;
  int height_;
  bool colors_;
  std::vector<std::string> lines_;
};

std::string speed_text(double samples) {
  return samples > 0 ? core::format_rate(samples, "samples") : "-";
}

std::string bar(double share, int columns) {
  const int full = static_cast<int>(std::floor(std::clamp(share, 0.0, 1.0) * columns));
  std::string text;
  for (int i = 0; i < columns; ++i) text += i < full ? "█" : "░";
  return text;
}

Style style_of(const v1::Job& job) {
  if (job.frames_failed() > 0) return Style::bad;
  if (job.state() == v1::JOB_STATE_PAUSED) return Style::faint;
  return job.leased() > 0 ? Style::good : Style::busy;
}

Style style_of(const v1::Worker& worker) {
  switch (worker.state()) {
    case v1::WORKER_STATE_ACTIVE:
      return worker.leased() > 0 ? Style::good : Style::plain;
    case v1::WORKER_STATE_DRAINING:
      return Style::busy;
    case v1::WORKER_STATE_QUARANTINED:
      return Style::bad;
    default:
      return Style::faint;
  }
}

void add_jobs(Page& page, std::vector<v1::Job> jobs, int room) {
  const std::vector<Column> columns = {
      {"JOB", -6}, {"NAME", 24},    {"OWNER", 10},  {"PRIO", -4},  {"STATE", 8}, {"", 12},
      {"", -7},    {"FRAMES", -11}, {"SPEED", -15}, {"LEFT", -11}, {"WHY", 40}};
  std::sort(jobs.begin(), jobs.end(), [](const v1::Job& a, const v1::Job& b) {
    if ((a.leased() > 0) != (b.leased() > 0)) return a.leased() > 0;
    if (a.priority() != b.priority()) return a.priority() > b.priority();
    return a.id() < b.id();
  });
  page.head(columns);
  if (jobs.empty()) page.line("  no job is open", Style::faint);
  const int shown =
      static_cast<int>(jobs.size()) <= room ? static_cast<int>(jobs.size()) : std::max(room - 1, 0);
  for (int i = 0; i < shown; ++i) {
    const v1::Job& job = jobs[static_cast<size_t>(i)];
    const double share = job.samples() == 0 ? 0
                                            : static_cast<double>(job.samples_done()) /
                                                  static_cast<double>(job.samples());
    const Style style = style_of(job);
    page.row(columns, {{std::to_string(job.id())},
                       {core::printable(job.name())},
                       {core::printable(job.owner()), Style::faint},
                       {std::to_string(job.priority())},
                       {job_look(job), style},
                       {bar(share, 12), style},
                       {percent(job.samples_done(), job.samples())},
                       {fmt::format("{}/{}", job.frames_done(), job.frames())},
                       {speed_text(job.samples_per_second())},
                       {job.seconds_left() >= 0 ? core::format_time_left(job.seconds_left()) : "-"},
                       {core::printable(job.reason()), Style::faint}});
  }
  if (shown < static_cast<int>(jobs.size())) {
    page.line(fmt::format("  and {} more", static_cast<int>(jobs.size()) - shown), Style::faint);
  }
}

void add_workers(Page& page, std::vector<v1::Worker> workers) {
  const std::vector<Column> columns = {
      {"WORKER", -6}, {"NAME", 24}, {"HOST", 15},   {"STATE", 11},  {"THREADS", -7}, {"OUT", -5},
      {"SPEED", -15}, {"DONE", -8}, {"FAILED", -6}, {"MEMORY", -9}, {"WHY", 40}};
  std::sort(workers.begin(), workers.end(), [](const v1::Worker& a, const v1::Worker& b) {
    if (a.state() != b.state()) return a.state() < b.state();
    return a.name() != b.name() ? is_before(a.name(), b.name()) : a.id() < b.id();
  });
  page.head(columns);
  if (workers.empty()) page.line("  no worker is there", Style::faint);
  const int room = page.room();
  const int shown = static_cast<int>(workers.size()) <= room ? static_cast<int>(workers.size())
                                                             : std::max(room - 1, 0);
  for (int i = 0; i < shown; ++i) {
    const v1::Worker& worker = workers[static_cast<size_t>(i)];
    page.row(columns,
             {{std::to_string(worker.id())},
              {core::printable(worker.name())},
              {core::printable(worker.host()), Style::faint},
              {state_name(worker.state()), style_of(worker)},
              {std::to_string(worker.threads())},
              {std::to_string(worker.leased())},
              {speed_text(worker.samples_per_second())},
              {core::format_count(worker.units_done())},
              {std::to_string(worker.units_failed()),
               worker.units_failed() > 0 ? Style::bad : Style::plain},
              {worker.memory_bytes() > 0 ? core::format_bytes(worker.memory_bytes()) : "-"},
              {core::printable(worker.reason()), Style::faint}});
  }
  if (shown < static_cast<int>(workers.size())) {
    page.line(fmt::format("  and {} more", static_cast<int>(workers.size()) - shown), Style::faint);
  }
}

}  // namespace

std::vector<std::string> top_page(const FarmNow& now, const std::string& coordinator, int width,
                                  int height, bool colors) {
  Page page(width, height, colors);
  size_t connected = 0;
  uint32_t threads = 0;
  double speed = 0;
  for (const v1::Worker& worker : now.workers) {
    if (worker.state() == v1::WORKER_STATE_GONE) continue;
    ++connected;
    threads += worker.threads();
    speed += worker.samples_per_second();
  }
  page.line(fmt::format("hyades top - {} - {}, {} with {}, {}", coordinator,
                        core::counted(now.jobs.size(), "job"), core::counted(connected, "worker"),
                        core::counted(threads, "thread"), speed_text(speed)));
  page.line(format_time(now.time_ms), Style::faint);
  // Two heads, and what lies between them; jobs get half of the rest, and what workers do not need.
  const int rows = std::max(height - 5, 0);
  const int for_workers =
      std::max<int>(std::min(static_cast<int>(std::max<size_t>(now.workers.size(), 1)), rows / 2),
                    rows - static_cast<int>(std::max<size_t>(now.jobs.size(), 1)));
  add_jobs(page, now.jobs, std::max(rows - for_workers, 0));
  page.line("");
  add_workers(page, now.workers);
  std::vector<std::string> lines = page.take();
  if (static_cast<int>(lines.size()) > height) lines.resize(static_cast<size_t>(height));
  return lines;
}

}  // namespace hyades::cli
