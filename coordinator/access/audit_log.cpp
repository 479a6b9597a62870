#include "coordinator/access/audit_log.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "coordinator/access/address.h"
#include "coordinator/access/token.h"
#include "farm/json_form.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostDetail = 500;
constexpr size_t kPiece = size_t{64} << 10U;
constexpr size_t kLongestLine = size_t{16} << 10U;
constexpr double kPurse = 10;       // refusals of one address, noted one by one
constexpr double kPerSecond = 0.1;  // ... and after that
constexpr size_t kMostPurses = 1000;
/// The purse of all whose neighbourhood has none of its own. To forget those that there are instead
/// would give everybody new ones, as often as somebody with a thousand addresses likes.
constexpr const char* kSharedPurse = "others";
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

v1::AuditEntry entry_for(const Caller& caller, const std::string& action, const std::string& target,
                         const grpc::Status& result, const std::string& detail) {
  v1::AuditEntry entry;
  entry.set_time_ms(token_clock_ms());
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
      actions_({options.folder, "audit", options.most_bytes, options.most_files}),
      refusals_({options.folder, "refusals", options.most_bytes, options.most_of_others}),
      uploads_({options.folder, "uploads", options.most_bytes, options.most_of_others}) {}

core::Result<std::unique_ptr<AuditLog>> AuditLog::open(const AuditOptions& options) {
  std::unique_ptr<AuditLog> log(new AuditLog(options));
  for (Book* book : log->books_) {
    if (core::Status opened = book->files.open(); !opened) return opened.error();
  }
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

void AuditLog::note(const Caller& caller, const std::string& action, const std::string& target,
                    const grpc::Status& result, const std::string& detail) {
  const std::lock_guard lock(mutex_);
  add(actions_, entry_for(caller, action, target, result, detail));
}

void AuditLog::upload(const Caller& caller, const std::string& action, const std::string& sha256,
                      const std::string& detail) {
  const std::lock_guard lock(mutex_);
  add(uploads_, entry_for(caller, action, sha256, grpc::Status::OK, detail));
}

void AuditLog::refuse(const Caller& caller, const std::string& action, const grpc::Status& why) {
  v1::AuditEntry entry = entry_for(caller, action, {}, why, {});
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  std::string whose = neighbourhood_of(caller.address);
  if (purses_.size() >= kMostPurses && !purses_.contains(whose)) whose = kSharedPurse;
  const auto [found, fresh] = purses_.try_emplace(whose, Purse{kPurse, now, {}});
  Purse& purse = found->second;
  const std::chrono::duration<double> passed = now - purse.since;
  purse.left = std::min(kPurse, purse.left + passed.count() * kPerSecond);
  purse.since = now;
  entry.set_times(purse.held.times() + 1);
  if (whose == kSharedPurse && entry.times() > 1) {
    entry.set_detail("of several addresses, this the last: " + entry.detail());
  }
  if (purse.left < 1) {
    purse.held = std::move(entry);
    return;
  }
  purse.left -= 1;
  purse.held.Clear();
  add(refusals_, std::move(entry));
}

/// Notes what stands for others and has waited long enough, or all; with the lock.
void AuditLog::release_held(bool all) {
  const int64_t before = token_clock_ms() - std::chrono::milliseconds(kHeldAtMost).count();
  for (auto purse = purses_.begin(); purse != purses_.end();) {
    v1::AuditEntry& held = purse->second.held;
    if (held.times() > 0 && (all || held.time_ms() < before)) {
      add(refusals_, std::move(held));
      held.Clear();
    }
    const bool idle = held.times() == 0 && Clock::now() - purse->second.since > 10 * kHeldAtMost;
    purse = idle ? purses_.erase(purse) : std::next(purse);
  }
}

/// With the lock.
void AuditLog::add(Book& book, v1::AuditEntry entry) {
  if (book.queue.size() >= most_waiting_) {
    ++book.lost;
    return;
  }
  if (book.lost > 0) {
    v1::AuditEntry gap;
    gap.set_time_ms(entry.time_ms());
    gap.set_deed("audit.lost");
    gap.set_result("data_loss");
    gap.set_detail("entries that the disk did not take in time");
    gap.set_times(std::exchange(book.lost, 0));
    book.queue.push_back(line_of(gap));
  }
  book.queue.push_back(line_of(entry));
  wake_.notify_all();
}

void AuditLog::flush() {
  std::unique_lock lock(mutex_);
  written_.wait_for(lock, kFlushPatience, [&] {
    return !busy_ && std::all_of(books_.begin(), books_.end(),
                                 [](const Book* book) { return book->queue.empty(); });
  });
}

/// Some of what waits in a book, without the lock meanwhile; whether the disk has taken it.
bool AuditLog::write_some(Book& book, std::unique_lock<std::mutex>& lock) {
  std::string lines;
  size_t count = 0;
  for (; count < book.queue.size() && lines.size() < kPiece; ++count) lines += book.queue[count];
  busy_ = true;
  lock.unlock();
  const bool done = book.files.write(lines);
  lock.lock();
  busy_ = false;
  if (done) book.queue.erase(book.queue.begin(), book.queue.begin() + static_cast<int64_t>(count));
  written_.notify_all();
  return done;
}

/// A piece of each book in turn, so that none waits for all of another.
void AuditLog::work() {
  std::unique_lock lock(mutex_);
  auto release = Clock::now() + kHeldAtMost / 2;
  for (;;) {
    if (Clock::now() >= release) {
      release_held(false);
      release = Clock::now() + kHeldAtMost / 2;
    }
    bool some = false;
    bool done = false;
    for (Book* book : books_) {
      if (book->queue.empty()) continue;
      some = true;
      done = write_some(*book, lock) || done;
    }
    if (!some) {
      if (stop_) return;
      wake_.wait_until(lock, release);
    } else if (!done) {
      if (stop_) return;
      wake_.wait_for(lock, kTryAgain, [&] { return stop_; });
    }
  }
}

AuditLog::Reader AuditLog::read() const {
  Reader reader;
  for (const Book* book : books_) {
    reader.rows_.emplace_back();
    reader.rows_.back().files = book->files.for_reading();
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
      head = entry_of(waiting.substr(begin, end - begin));
      begin = end + 1;
      if (head) return;
      continue;
    }
    waiting.erase(0, begin);
    begin = 0;
    // Nobody but us writes there; what has no end is not ours.
    if (waiting.size() > kLongestLine) waiting.clear();
    if (files.empty()) return;
    const size_t had = waiting.size();
    waiting.resize(had + kPiece);
    const ssize_t got = ::read(files.back().get(), waiting.data() + had, kPiece);
    waiting.resize(had + static_cast<size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) {
      files.pop_back();
      waiting.clear();
    }
  }
}

}  // namespace hyades::coordinator
