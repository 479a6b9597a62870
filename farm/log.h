#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/film/unit.h"

namespace hyades::farm {

/// What coordinator and worker tell those who run them, on standard error: a line each, as text for
/// people and journals or as JSON for what collects logs.
enum class LogLevel : uint8_t { debug, info, warning, error };
enum class LogFormat : uint8_t { text, json };

struct LogOptions {
  LogLevel level = LogLevel::info;  ///< and what is weightier
  LogFormat format = LogFormat::text;
};

/// What a line is about, as far as it is about any of these.
struct LogFields {
  std::optional<uint64_t> job;
  std::optional<int32_t> frame;
  std::string unit;    ///< its tile and batches, as unit_field has them
  std::string worker;  ///< its name
};

/// "64,32 batches 0-3": the first corner of the unit's tile, and its batches.
std::string unit_field(const core::Unit& unit);

/// For the whole process; before it has threads. `program` ("hyades worker") stands before each
/// line of text, and in JSON as a field.
void set_log(std::string_view program, const LogOptions& options = {});

/// The format that set_log has chosen for this process.
LogFormat log_format();

/// Whether lines of this level are written: for those that cost something to make.
bool logs(LogLevel level);

/// Writes one line, whole, whatever other threads write. What is not printable, or not UTF-8, is
/// replaced.
void log(LogLevel level, std::string_view text, const LogFields& fields = {});

/// Writes one line as log() does, but soon and by a thread of its own, in the order in which they
/// were said: for those who may not wait for whoever reads. Of lines that nobody reads ten thousand
/// wait; how many more there were is told afterwards. What waits at the process' end has a second
/// to be read.
void log_later(LogLevel level, std::string text, LogFields fields = {});

/// The line without its end, as of `time_ms` since 1970, UTC (text has no time: journals add it).
std::string log_line(std::string_view program, LogFormat format, int64_t time_ms, LogLevel level,
                     std::string_view text, const LogFields& fields);

/// "debug", "info", "warning", "error".
core::Result<LogLevel> read_log_level(const std::string& name);
/// "text", "json".
core::Result<LogFormat> read_log_format(const std::string& name);

}  // namespace hyades::farm
