#include "coordinator/access/audit_log.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "coordinator/access/address.h"
#include "coordinator/access/audit_chain.h"
#include "coordinator/access/token.h"
#include "core/base/hash.h"
#include "core/base/posix_file.h"
#include "core/base/wall_clock.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostDetail = 500;
constexpr size_t kPiece = size_t{64} << 10U;
constexpr size_t kLongestLine = size_t{16} << 10U;
constexpr double kBurst = 10;            // refusals of one neighbourhood that are noted at once
constexpr double kPerSecond = 0.1;       // ... and after that
constexpr double kActionBurst = 2000;    // actions by one token that are noted at once
constexpr double kActionsPerSecond = 1;  // ... and after that
constexpr size_t kMostLimits = 1000;
/// The limit of all whose neighbourhood has none of its own. To forget those that there are instead
/// would give everybody new ones, as often as somebody with a thousand addresses likes.
constexpr const char* kSharedLimit = "others";
constexpr std::chrono::seconds kHeldAtMost{60};
constexpr std::chrono::seconds kTryAgain{1};
constexpr std::chrono::seconds kFlushPatience{2};

v1::AuditEntry entry_for(const Caller& caller, const std::string& action, const std::string& target,
                         const grpc::Status& result, const std::string& detail) {
  v1::AuditEntry entry;
  entry.set_time_ms(core::wall_ms());
  entry.set_token_id(caller.token_id);
  entry.set_name(caller.name);
  entry.set_role(caller.role);
  entry.set_address(farm::wire_text(caller.address));
  entry.set_deed(action);
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

AuditLog::AuditLog(const AuditOptions& options)
    : most_waiting_(options.most_waiting),
      logs_{RotatingLog({options.folder, "audit", options.most_bytes, options.most_files}),
            RotatingLog({options.folder, "refusals", options.most_bytes, options.most_of_others}),
            RotatingLog({options.folder, "uploads", options.most_bytes, options.most_of_others})} {}

core::Result<std::unique_ptr<AuditLog>> AuditLog::open(const AuditOptions& options) {
  std::unique_ptr<AuditLog> log(new AuditLog(options));
  for (size_t kind = 0; kind < kKinds; ++kind) {
    if (core::Status opened = log->logs_[kind].open(); !opened) return opened.error();
    if (const auto last = read_audit_line(log->logs_[kind].last_line())) {
      const core::MutexLock lock(log->mutex_);
      log->queues_[kind].last = audit_digest(*last);
    }
  }
  log->thread_ = std::thread([&me = *log] { me.work(); });
  return log;
}

AuditLog::~AuditLog() {
  {
    const core::MutexLock lock(mutex_);
    stop_ = true;
    release_held(true);
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void AuditLog::note(const Caller& caller, const std::string& action, const std::string& target,
                    const grpc::Status& result, const std::string& detail) {
  v1::AuditEntry entry = entry_for(caller, action, target, result, detail);
  // A farm without tokens has one person.
  const std::string whose = caller.token_id.empty() ? caller.name : caller.token_id;
  const bool steers_all = caller.role == v1::ROLE_ADMIN || caller.role == v1::ROLE_OPERATOR;
  const auto now = Clock::now();
  const core::MutexLock lock(mutex_);
  if (!result.ok()) {
    const RateLimit fresh{{kBurst, kPerSecond, now}, kRefusals};
    add_or_hold(failures_.try_emplace(whose, fresh).first->second, std::move(entry));
  } else if (steers_all) {
    add(kActions, std::move(entry));
  } else {
    const RateLimit fresh{{kActionBurst, kActionsPerSecond, now}, kActions};
    add_or_hold(actions_of_.try_emplace(whose, fresh).first->second, std::move(entry));
  }
}

void AuditLog::add_or_hold(RateLimit& limit, v1::AuditEntry entry) {
  entry.set_times(limit.held.times() + 1);
  if (!limit.bucket.take(Clock::now())) {
    limit.held = std::move(entry);
    return;
  }
  limit.held.Clear();
  add(limit.kind, std::move(entry));
}

void AuditLog::upload(const Caller& caller, const std::string& action, const std::string& sha256,
                      const std::string& detail) {
  const core::MutexLock lock(mutex_);
  add(kUploads, entry_for(caller, action, sha256, grpc::Status::OK, detail));
}

void AuditLog::refuse(const Caller& caller, const std::string& action, const grpc::Status& why) {
  v1::AuditEntry entry = entry_for(caller, action, {}, why, {});
  const auto now = Clock::now();
  const core::MutexLock lock(mutex_);
  std::string whose = neighbourhood_of(caller.address);
  if (limits_.size() >= kMostLimits && !limits_.contains(whose)) whose = kSharedLimit;
  const RateLimit fresh{{kBurst, kPerSecond, now}, kRefusals};
  RateLimit& limit = limits_.try_emplace(whose, fresh).first->second;
  if (whose == kSharedLimit && limit.held.times() > 0) {
    entry.set_detail("of several addresses, this the last: " + entry.detail());
  }
  add_or_hold(limit, std::move(entry));
}

/// Notes what stands for others and has waited long enough, or all.
void AuditLog::release_held(bool all) {
  for (Limits* limits : {&limits_, &failures_, &actions_of_}) release_of(*limits, all);
}

void AuditLog::release_of(Limits& limits, bool all) {
  const int64_t before = core::wall_ms() - std::chrono::milliseconds(kHeldAtMost).count();
  for (auto limit = limits.begin(); limit != limits.end();) {
    v1::AuditEntry& held = limit->second.held;
    if (held.times() > 0 && (all || held.time_ms() < before)) {
      add(limit->second.kind, std::move(held));
      held.Clear();
    }
    const bool idle =
        held.times() == 0 && Clock::now() - limit->second.bucket.asked() > 10 * kHeldAtMost;
    limit = idle ? limits.erase(limit) : std::next(limit);
  }
}

void AuditLog::add(Kind kind, v1::AuditEntry entry) {
  Queue& queue = queues_[kind];
  if (queue.lines.size() >= most_waiting_) {
    ++queue.lost;
    return;
  }
  if (queue.lost > 0) {
    v1::AuditEntry gap;
    gap.set_time_ms(entry.time_ms());
    gap.set_deed("audit.lost");
    gap.set_result("data_loss");
    gap.set_detail("entries that the disk did not take in time");
    gap.set_times(std::exchange(queue.lost, 0));
    queue.append(std::move(gap));
  }
  queue.append(std::move(entry));
  wake_.notify_all();
}

void AuditLog::Queue::append(v1::AuditEntry entry) {
  entry.set_previous(last);
  const std::string line = audit_line(entry);
  last = core::to_hex(core::sha256(line));
  lines.push_back(line + "\n");
}

void AuditLog::flush() {
  const auto end = Clock::now() + kFlushPatience;
  const core::MutexLock lock(mutex_);
  while (!all_written() && Clock::now() < end) written_.wait_until(mutex_, end);
}

bool AuditLog::all_written() const {
  return !busy_ && std::all_of(queues_.begin(), queues_.end(),
                               [](const Queue& queue) { return queue.lines.empty(); });
}

/// Some of what waits in a queue, without the lock meanwhile; whether the disk has taken it.
bool AuditLog::write_some(Kind kind) {
  std::deque<std::string>& waiting = queues_[kind].lines;
  std::string lines;
  size_t count = 0;
  for (; count < waiting.size() && lines.size() < kPiece; ++count) lines += waiting[count];
  busy_ = true;
  mutex_.unlock();
  const bool done = logs_[kind].write(lines);
  mutex_.lock();
  busy_ = false;
  if (done) waiting.erase(waiting.begin(), waiting.begin() + static_cast<int64_t>(count));
  written_.notify_all();
  return done;
}

/// A piece of each queue in turn, so that none waits for all of another.
void AuditLog::work() {
  const core::MutexLock lock(mutex_);
  auto release = Clock::now() + kHeldAtMost / 2;
  for (;;) {
    if (Clock::now() >= release) {
      release_held(false);
      release = Clock::now() + kHeldAtMost / 2;
    }
    bool some = false;
    bool done = false;
    for (const Kind kind : {kActions, kRefusals, kUploads}) {
      if (queues_[kind].lines.empty()) continue;
      some = true;
      done = write_some(kind) || done;
    }
    if (!some) {
      if (stop_) return;
      wake_.wait_until(mutex_, release);
    } else if (!done) {
      if (stop_) return;
      const auto again = Clock::now() + kTryAgain;
      while (!stop_ && Clock::now() < again) wake_.wait_until(mutex_, again);
    }
  }
}

AuditLog::Reader AuditLog::read() const {
  Reader reader;
  for (const RotatingLog& log : logs_) {
    reader.rows_.emplace_back();
    reader.rows_.back().log = log.name();
    reader.rows_.back().files = log.for_reading();
    reader.rows_.back().step();
  }
  return reader;
}

/// Each kind is written in order of time, but for what was held back: so they are merged.
std::optional<v1::AuditEntry> AuditLog::Reader::next() {
  Row* oldest = nullptr;
  for (Row& row : rows_) {
    if (!row.head) continue;
    // Of the same moment uploads, the last row, come first: a submission follows them.
    if (oldest == nullptr || row.head->time_ms() <= oldest->head->time_ms()) oldest = &row;
  }
  if (oldest == nullptr) return std::nullopt;
  std::optional<v1::AuditEntry> entry = std::exchange(oldest->head, std::nullopt);
  oldest->step();
  return entry;
}

void AuditLog::Reader::Row::step() {
  for (;;) {
    const size_t end = waiting.find('\n', begin);
    if (end != std::string::npos) {
      head = read_audit_line(waiting.substr(begin, end - begin));
      begin = end + 1;
      if (!head) continue;
      head->set_log(log);
      return;
    }
    waiting.erase(0, begin);
    begin = 0;
    // Nobody but us writes there; what has no end is not ours.
    if (waiting.size() > kLongestLine) waiting.clear();
    if (files.empty()) return;
    const size_t had = waiting.size();
    waiting.resize(had + kPiece);
    const auto piece = std::as_writable_bytes(std::span(waiting).subspan(had));
    const size_t got = core::read_all(files.back().get(), piece).value_or(0);
    waiting.resize(had + got);
    if (got == 0) {
      files.pop_back();
      waiting.clear();
    }
  }
}

}  // namespace hyades::coordinator
