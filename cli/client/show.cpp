#include "cli/client/show.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/base/wall_clock.h"

namespace hyades::cli {
namespace {

size_t columns_of(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

}  // namespace

std::string json_line(const Json& json) {
  // What is no ASCII is escaped, for names may turn a terminal's text around; what is no UTF-8
  // becomes a replacement character, not an exception.
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

void print_json(const Json& json) { std::printf("%s\n", json_line(json).c_str()); }

std::string job_look(const v1::Job& job) {
  return job.waiting() ? "waiting" : state_name(job.state());
}

std::string job_trouble(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_PAUSED) return "paused";
  if (!job.reason().empty()) return core::printable(job.reason());
  return job_look(job) == "waiting" ? "waiting for its turn" : "";
}

std::optional<double> seconds_taken(const v1::Job& job) {
  if (job.busy_seconds() > 0) return job.busy_seconds();
  const bool begun_once = job.begun_ms() != 0 || job.samples_done() > 0 || job.frames_done() > 0;
  if (!begun_once) return std::nullopt;
  const int64_t begun = job.begun_ms() != 0 ? job.begun_ms() : job.submitted_ms();
  const int64_t ended = job.ended_ms() != 0 ? job.ended_ms() : core::wall_ms();
  return 1e-3 * static_cast<double>(std::max<int64_t>(ended - begun, 0));
}

bool is_before(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  // The digits at the beginning, without zeros that say nothing.
  const auto take_number = [&](std::string_view& text) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
    std::string_view digits = text.substr(0, static_cast<size_t>(end - text.begin()));
    text.remove_prefix(digits.size());
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    return digits;
  };
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view m = take_number(a);
      const std::string_view n = take_number(b);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      continue;
    }
    if (a.front() != b.front()) return a.front() < b.front();
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  return a.size() != b.size() ? a.size() < b.size() : whole_a < whole_b;
}

std::string percent(uint64_t part, uint64_t whole) {
  if (whole == 0) return "-";
  // Never "100.0 %" of what is not complete.
  const double share = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{:.1f} %", part < whole ? std::min(share, 99.9) : share);
}

std::string format_time(int64_t ms) {
  const std::time_t seconds = ms / 1000;
  std::tm local{};
  localtime_r(&seconds, &local);
  return fmt::format("{:%F %T}", local);
}

void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], columns_of(row[i]));
  }
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      line += core::printable(row[i]);
      if (i + 1 < row.size()) line.append(widths[i] - columns_of(row[i]) + 2, ' ');
    }
    std::printf("%s\n", line.c_str());
  }
}

}  // namespace hyades::cli
