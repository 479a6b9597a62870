#include "farm/log.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/mutex.h"
#include "core/base/printable.h"
#include "core/base/wall_clock.h"

namespace hyades::farm {
namespace {

struct Log {
  std::string program = "hyades";
  LogOptions options;
};

Log& the_log() {
  static auto* log = new Log;  // there for whoever writes while the process ends
  return *log;
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

void write_line(int64_t time_ms, LogLevel level, std::string_view text, const LogFields& fields) {
  const Log& log = the_log();
  const std::string line =
      log_line(log.program, log.options.format, time_ms, level, text, fields) + "\n";
  // One call, so that lines of several threads do not mix. Where nobody reads there is nobody to
  // tell.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

/// Writes lines for those who may not wait.
class Scribe {
 public:
  /// Of the process. Never destroyed: its thread may hang in a write for ever.
  static Scribe& get() {
    static auto* scribe = new Scribe;
    return *scribe;
  }

  void say(LogLevel level, std::string text, LogFields fields) {
    const core::MutexLock lock(mutex_);
    if (lines_.size() >= kMostWaiting) {
      ++left_out_;
      return;
    }
    lines_.push_back({level, core::wall_ms(), std::move(text), std::move(fields)});
    wake_.notify_one();
  }

 private:
  struct Line {
    LogLevel level;
    int64_t time_ms;
    std::string text;
    LogFields fields;
  };
  static constexpr size_t kMostWaiting = 10'000;
  static constexpr std::chrono::seconds kGoodbye{1};

  Scribe() {
    std::thread([this] { write(); }).detach();
    (void)std::atexit([] { get().flush(); });
  }

  void flush() {
    const auto end = std::chrono::steady_clock::now() + kGoodbye;
    const core::MutexLock lock(mutex_);
    while ((!lines_.empty() || writing_) && std::chrono::steady_clock::now() < end) {
      written_.wait_until(mutex_, end);
    }
  }

  void write() {
    core::MutexLock lock(mutex_);
    for (;;) {
      writing_ = false;
      if (lines_.empty()) written_.notify_all();
      while (lines_.empty()) wake_.wait(mutex_);
      writing_ = true;
      const Line line = std::move(lines_.front());
      lines_.pop_front();
      const uint64_t left_out = lines_.empty() ? std::exchange(left_out_, 0) : 0;
      lock.unlock();
      write_line(line.time_ms, line.level, line.text, line.fields);
      if (left_out > 0) {
        log(LogLevel::warning, fmt::format("{} lines were left out: nobody read them", left_out));
      }
      lock.lock();
    }
  }

  core::Mutex mutex_;
  core::CondVar wake_;
  core::CondVar written_;
  std::deque<Line> lines_ HYADES_GUARDED_BY(mutex_);
  uint64_t left_out_ HYADES_GUARDED_BY(mutex_) = 0;
  bool writing_ HYADES_GUARDED_BY(mutex_) = false;
};

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
  if (level == LogLevel::warning) line += "WARNING: ";
  if (level == LogLevel::debug) line += "debug: ";
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
  std::replace(line.begin(), line.end(), '\n', ' ');
  return core::printable(line);
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

std::string unit_field(const core::Unit& unit) {
  return fmt::format("{},{} batches {}-{}", unit.tile.x0, unit.tile.y0, unit.batches.first,
                     int64_t{unit.batches.end()} - 1);
}

LogFormat log_format() { return the_log().options.format; }

bool logs(LogLevel level) { return level >= the_log().options.level; }

void log(LogLevel level, std::string_view text, const LogFields& fields) {
  if (!logs(level)) return;
  write_line(core::wall_ms(), level, text, fields);
}

void log_later(LogLevel level, std::string text, LogFields fields) {
  if (!logs(level)) return;
  Scribe::get().say(level, std::move(text), std::move(fields));
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
