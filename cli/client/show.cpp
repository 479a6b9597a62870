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

void print_json(const Json& json) {
  // What is no ASCII is escaped, for names may turn a terminal's text around; what is no UTF-8
  // becomes a replacement character, not an exception.
  std::printf("%s\n", json.dump(-1, ' ', true, Json::error_handler_t::replace).c_str());
}

std::string job_look(const v1::Job& job) {
  const bool waits = job.state() == v1::JOB_STATE_RUNNING && job.leased() == 0 &&
                     job.samples_done() < job.samples();
  return waits ? "waiting" : state_name(job.state());
}

double seconds_taken(const v1::Job& job) {
  const int64_t begun = job.begun_ms() != 0 ? job.begun_ms() : job.submitted_ms();
  const int64_t ended = job.ended_ms() != 0 ? job.ended_ms() : core::wall_ms();
  return 1e-3 * static_cast<double>(std::max<int64_t>(ended - begun, 0));
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
