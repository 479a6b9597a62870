#include "farm/log.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace hyades::farm {
namespace {

struct Log {
  std::string program = "hyades";
  LogOptions options;
};

Log& the_log() {
  static Log log;
  return log;
}

constexpr std::array<std::pair<LogLevel, const char*>, 4> kLevels = {
    {{LogLevel::debug, "debug"},
     {LogLevel::info, "info"},
     {LogLevel::warning, "warning"},
     {LogLevel::error, "error"}}};

const char* name_of(LogLevel level) {
  for (const auto& [known, name] : kLevels) {
    if (known == level) return name;
  }
  return "error";
}

/// 2026-01-31T12:00:00.123Z
std::string utc(int64_t time_ms) {
  const std::time_t seconds = time_ms / 1000;
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  std::array<char, 32> date{};
  const size_t length = std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  return fmt::format("{}.{:03}Z", std::string_view(date.data(), length), time_ms % 1000);
}

std::string text_line(std::string_view program, LogLevel level, std::string_view text,
                      const LogFields& fields) {
  std::string line = fmt::format("{}: ", program);
  if (level == LogLevel::warning || level == LogLevel::debug) {
    line += fmt::format("{}: ", name_of(level));
  }
  line += text;
  std::string about;
  const auto add = [&](const char* name, const auto& value) {
    about += fmt::format("{}{} {}", about.empty() ? "" : ", ", name, value);
  };
  if (fields.job) add("job", *fields.job);
  if (fields.frame) add("frame", *fields.frame);
  if (!fields.unit.empty()) add("unit", fields.unit);
  if (!fields.worker.empty()) add("worker", fields.worker);
  if (!about.empty()) line += " (" + about + ")";
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
  }
  return line;
}

std::string json_line(std::string_view program, int64_t time_ms, LogLevel level,
                      std::string_view text, const LogFields& fields) {
  nlohmann::ordered_json line = {
      {"time", utc(time_ms)}, {"level", name_of(level)}, {"program", program}, {"text", text}};
  if (fields.job) line["job"] = *fields.job;
  if (fields.frame) line["frame"] = *fields.frame;
  if (!fields.unit.empty()) line["unit"] = fields.unit;
  if (!fields.worker.empty()) line["worker"] = fields.worker;
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

void set_log(std::string_view program, const LogOptions& options) {
  the_log() = {std::string(program), options};
}

bool logs(LogLevel level) { return level >= the_log().options.level; }

void log(LogLevel level, std::string_view text, const LogFields& fields) {
  if (!logs(level)) return;
  const int64_t now = std::chrono::duration_cast<std::chrono::milliseconds>(
                          std::chrono::system_clock::now().time_since_epoch())
                          .count();
  const Log& log = the_log();
  const std::string line =
      log_line(log.program, log.options.format, now, level, text, fields) + "\n";
  // One call, so that lines of several threads do not mix. Where nobody reads there is nobody to
  // tell.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

std::string log_line(std::string_view program, LogFormat format, int64_t time_ms, LogLevel level,
                     std::string_view text, const LogFields& fields) {
  return format == LogFormat::json ? json_line(program, time_ms, level, text, fields)
                                   : text_line(program, level, text, fields);
}

core::Result<LogLevel> read_log_level(const std::string& name) {
  for (const auto& [level, known] : kLevels) {
    if (name == known) return level;
  }
  return core::Error{"'" + name + "': expected debug, info, warning or error"};
}

core::Result<LogFormat> read_log_format(const std::string& name) {
  if (name == "text") return LogFormat::text;
  if (name == "json") return LogFormat::json;
  return core::Error{"'" + name + "': expected text or json"};
}

}  // namespace hyades::farm
