#include "coordinator/access/audit_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "coordinator/access/address.h"
#include "coordinator/access/token.h"
#include "core/base/io_reason.h"
#include "farm/json_form.h"
#include "farm/log.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostWaiting = 10'000;
constexpr size_t kMostDetail = 500;
constexpr size_t kPiece = size_t{64} << 10U;
constexpr size_t kLongestLine = size_t{16} << 10U;
constexpr double kPurse = 10;       // refusals of one address, noted one by one
constexpr double kPerSecond = 0.1;  // ... and after that
constexpr size_t kMostPurses = 1000;
constexpr std::chrono::seconds kHeldAtMost{60};
constexpr std::chrono::seconds kTryAgain{1};
constexpr std::chrono::seconds kFlushPatience{2};

std::string line_of(const v1::AuditEntry& entry) {
  farm::Json line = farm::to_json(entry);
  return line.dump(-1, ' ', false, farm::Json::error_handler_t::replace) + "\n";
}

template <class Number>
Number number_in(const farm::Json& line, const char* name) {
  const auto found = line.find(name);
  return found != line.end() && found->is_number_integer() ? found->get<Number>() : Number{};
}

std::string text_in(const farm::Json& line, const char* name) {
  const auto found = line.find(name);
  return found != line.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<v1::AuditEntry> entry_of(const std::string& text) {
  const farm::Json line = farm::Json::parse(text, nullptr, false);
  if (!line.is_object() || text_in(line, "deed").empty()) return std::nullopt;
  v1::AuditEntry entry;
  entry.set_time_ms(number_in<int64_t>(line, "time_ms"));
  entry.set_token_id(text_in(line, "token_id"));
  entry.set_name(text_in(line, "name"));
  entry.set_role(farm::role_of(text_in(line, "role")).value_or(v1::ROLE_UNSPECIFIED));
  entry.set_address(text_in(line, "address"));
  entry.set_deed(text_in(line, "deed"));
  entry.set_target(text_in(line, "target"));
  entry.set_result(text_in(line, "result"));
  entry.set_detail(text_in(line, "detail"));
  entry.set_times(number_in<uint64_t>(line, "times"));
  return entry;
}

v1::AuditEntry entry_for(const Caller& caller, const std::string& deed, const std::string& target,
                         const grpc::Status& result, const std::string& detail) {
  v1::AuditEntry entry;
  entry.set_time_ms(token_clock_ms());
  entry.set_token_id(caller.token_id);
  entry.set_name(caller.name);
  entry.set_role(caller.role);
  entry.set_address(farm::wire_text(caller.address));
  entry.set_deed(deed);
  entry.set_target(farm::wire_text(target.substr(0, kMostDetail)));
  entry.set_result(result_name(result));
  const std::string& why = result.ok() ? detail : result.error_message();
  entry.set_detail(farm::wire_text(why.substr(0, kMostDetail)));
  entry.set_times(1);
  return entry;
}

}  // namespace

std::string result_name(const grpc::Status& status) {
  static const char* const kNames[] = {"ok",
                                       "cancelled",
                                       "unknown",
                                       "invalid_argument",
                                       "deadline_exceeded",
                                       "not_found",
                                       "already_exists",
                                       "permission_denied",
                                       "resource_exhausted",
                                       "failed_precondition",
                                       "aborted",
                                       "out_of_range",
                                       "unimplemented",
                                       "internal",
                                       "unavailable",
                                       "data_loss",
                                       "unauthenticated"};
  const auto code = static_cast<size_t>(status.error_code());
  return code < std::size(kNames) ? kNames[code] : "unknown";
}

core::Result<std::unique_ptr<AuditLog>> AuditLog::open(AuditOptions options) {
  std::unique_ptr<AuditLog> log(new AuditLog(std::move(options)));
  if (core::Status opened = log->open_file(); !opened) return opened.error();
  log->thread_ = std::thread([&me = *log] { me.work(); });
  return log;
}

AuditLog::~AuditLog() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    release_held(true);
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string AuditLog::path(int number) const {
  return options_.folder + "/audit." + (number == 0 ? "" : std::to_string(number) + ".") + "jsonl";
}

core::Status AuditLog::open_file() {
  constexpr mode_t kOwnerOnly = 0600;
  file_ = core::Descriptor(
      ::open(path(0).c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, kOwnerOnly));
  struct stat facts {};
  if (!file_.valid() || ::fstat(file_.get(), &facts) != 0) {
    return core::Error{path(0) + ": cannot be opened: " + core::io_reason(errno)};
  }
  size_ = static_cast<uint64_t>(facts.st_size);
  // A crash may have cut the last line.
  char last = '\n';
  if (size_ > 0 && ::pread(file_.get(), &last, 1, facts.st_size - 1) == 1 && last != '\n') {
    if (::write(file_.get(), "\n", 1) == 1) ++size_;
  }
  return {};
}

void AuditLog::note(const Caller& caller, const std::string& deed, const std::string& target,
                    const grpc::Status& result, const std::string& detail) {
  const std::lock_guard lock(mutex_);
  add(entry_for(caller, deed, target, result, detail));
}

void AuditLog::refuse(const Caller& caller, const std::string& deed, const grpc::Status& why) {
  v1::AuditEntry entry = entry_for(caller, deed, {}, why, {});
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  if (purses_.size() >= kMostPurses && !purses_.contains(neighbourhood_of(caller.address))) {
    release_held(true);
    purses_.clear();
  }
  const auto [found, fresh] =
      purses_.try_emplace(neighbourhood_of(caller.address), Purse{kPurse, now, {}});
  Purse& purse = found->second;
  const std::chrono::duration<double> passed = now - purse.since;
  purse.left = std::min(kPurse, purse.left + passed.count() * kPerSecond);
  purse.since = now;
  entry.set_times(purse.held.times() + 1);
  if (purse.left < 1) {
    purse.held = std::move(entry);
    return;
  }
  purse.left -= 1;
  purse.held.Clear();
  add(std::move(entry));
}

/// Notes what stands for others and has waited long enough, or all; with the lock.
void AuditLog::release_held(bool all) {
  const int64_t before = token_clock_ms() - std::chrono::milliseconds(kHeldAtMost).count();
  for (auto purse = purses_.begin(); purse != purses_.end();) {
    v1::AuditEntry& held = purse->second.held;
    if (held.times() > 0 && (all || held.time_ms() < before)) {
      add(std::move(held));
      held.Clear();
    }
    const bool idle = held.times() == 0 && Clock::now() - purse->second.since > 10 * kHeldAtMost;
    purse = idle ? purses_.erase(purse) : std::next(purse);
  }
}

/// With the lock.
void AuditLog::add(v1::AuditEntry entry) {
  if (queue_.size() >= kMostWaiting) {
    ++lost_;
    return;
  }
  if (lost_ > 0) {
    v1::AuditEntry gap;
    gap.set_time_ms(entry.time_ms());
    gap.set_deed("audit.lost");
    gap.set_result("data_loss");
    gap.set_detail("entries that the disk did not take in time");
    gap.set_times(std::exchange(lost_, 0));
    queue_.push_back(line_of(gap));
  }
  queue_.push_back(line_of(entry));
  wake_.notify_all();
}

void AuditLog::flush() {
  std::unique_lock lock(mutex_);
  written_.wait_for(lock, kFlushPatience, [&] { return queue_.empty() && !busy_; });
}

void AuditLog::work() {
  std::unique_lock lock(mutex_);
  while (!stop_ || !queue_.empty()) {
    if (queue_.empty()) {
      wake_.wait_for(lock, kHeldAtMost / 2);
      release_held(false);
      continue;
    }
    std::string lines;
    size_t count = 0;
    for (; count < queue_.size() && lines.size() < kPiece; ++count) lines += queue_[count];
    busy_ = true;
    lock.unlock();
    const bool done = write(lines);
    lock.lock();
    busy_ = false;
    if (done) {
      queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
      written_.notify_all();
    } else if (stop_) {
      return;
    } else {
      wake_.wait_for(lock, kTryAgain, [&] { return stop_; });
    }
  }
}

/// All of it, or none that counts: what is cut off by a full disk is taken away again.
bool AuditLog::write(const std::string& lines) {
  if (size_ > 0 && size_ + lines.size() > options_.most_bytes) rotate();
  if (!file_.valid() && !open_file()) return false;
  size_t written = 0;
  while (written < lines.size()) {
    const ssize_t got = ::write(file_.get(), lines.data() + written, lines.size() - written);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      (void)::ftruncate(file_.get(), static_cast<off_t>(size_));
      return false;
    }
    written += static_cast<size_t>(got);
  }
  size_ += lines.size();
  (void)::fdatasync(file_.get());
  return true;
}

void AuditLog::rotate() {
  (void)::unlink(path(options_.most_files - 1).c_str());
  for (int number = options_.most_files - 2; number >= 0; --number) {
    (void)std::rename(path(number).c_str(), path(number + 1).c_str());
  }
  file_.close();
  if (auto opened = open_file(); !opened) {
    farm::log(farm::LogLevel::error, opened.error().message);
  }
}

AuditLog::Reader AuditLog::read() const {
  Reader reader;
  for (int number = 0; number < options_.most_files; ++number) {
    core::Descriptor file(::open(path(number).c_str(), O_RDONLY | O_CLOEXEC));
    if (file.valid()) reader.files_.push_back(std::move(file));
  }
  return reader;
}

std::optional<v1::AuditEntry> AuditLog::Reader::next() {
  for (;;) {
    const size_t end = waiting_.find('\n', begin_);
    if (end != std::string::npos) {
      const std::string line = waiting_.substr(begin_, end - begin_);
      begin_ = end + 1;
      if (auto entry = entry_of(line)) return entry;
      continue;
    }
    waiting_.erase(0, begin_);
    begin_ = 0;
    // Nobody but us writes there; what has no end is not ours.
    if (waiting_.size() > kLongestLine) waiting_.clear();
    if (files_.empty()) return std::nullopt;
    const size_t had = waiting_.size();
    waiting_.resize(had + kPiece);
    const ssize_t got = ::read(files_.back().get(), waiting_.data() + had, kPiece);
    waiting_.resize(had + static_cast<size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) {
      files_.pop_back();
      waiting_.clear();
    }
  }
}

}  // namespace hyades::coordinator
