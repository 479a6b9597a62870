#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/printable.h"
#include "farm/json_form.h"

namespace hyades::cli {

using farm::Json;
using farm::level_name;
using farm::state_name;
using farm::to_json;

/// JSON in one line, in ASCII.
std::string json_line(const Json& json);

/// Prints JSON in one line to standard output.
void print_json(const Json& json);

/// Prints an array of rows, messages of the wire, without an end of line. One at a time: as JSON a
/// row takes many times its memory.
template <class Rows>
void print_json_rows(const Rows& rows) {
  const char* before = "[";
  for (const auto& row : rows) {
    std::printf("%s%s", before, json_line(to_json(row)).c_str());
    before = ",";
  }
  std::printf("%s]", rows.empty() ? "[" : "");
}

/// What people call a job's state: that of one that runs, and waits, is "waiting".
std::string job_look(const v1::Job& job);

/// Why it does not get on, in a few words; empty where it does.
std::string job_trouble(const v1::Job& job);

/// Seconds in which somebody worked on the job (of one that an older coordinator tells of: from its
/// beginning to its end, or to now); nothing of one that nobody has begun.
std::optional<double> seconds_taken(const v1::Job& job);

/// Whether `a` comes before `b`, what is digits in both compared as numbers: "w9" before "w10".
bool is_before(std::string_view a, std::string_view b);

/// "62.5 %" of something that may be nothing.
std::string percent(uint64_t part, uint64_t whole);

/// Local time of day and date of milliseconds since 1970: "2026-11-21 17:54:38".
std::string format_time(int64_t ms);

/// Prints rows in columns to standard output; the first row is the heading.
void print_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace hyades::cli
