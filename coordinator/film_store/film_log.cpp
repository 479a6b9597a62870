#include "coordinator/film_store/film_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <sstream>
#include <utility>

#include "coordinator/film_store/log_names.h"
#include "coordinator/film_store/segment.h"
#include "core/base/failpoint.h"
#include "core/base/parallel.h"

namespace hyades::coordinator {
namespace {

using core::Error;
using core::Result;
using core::Status;

constexpr const char* kGuardTitle = "hyades film log 1";
constexpr uint64_t kGroupBytes = uint64_t{8} << 20U;  ///< a group this large waits for no more
constexpr std::chrono::milliseconds kRetryDelay{250};

Status write_whole(LogFiles& files, const std::string& path, const std::string& text) {
  Result<std::unique_ptr<LogWriter>> writer = files.create(path);
  if (!writer) return writer.error();
  if (Status s = (*writer)->write(std::as_bytes(std::span(text))); !s) return s;
  return (*writer)->sync();
}

Result<std::string> read_whole(LogFiles& files, const std::string& path, uint64_t at_most) {
  Result<std::unique_ptr<LogReader>> reader = files.open(path);
  if (!reader) return reader.error();
  std::string text(static_cast<size_t>(std::min((*reader)->size(), at_most)), '\0');
  if (Status s = (*reader)->read(0, std::as_writable_bytes(std::span(text))); !s) return s.error();
  return text;
}

}  // namespace

FilmLog::FilmLog(std::string folder, FilmLogOptions options, LogFiles& files)
    : folder_(std::move(folder)), options_(std::move(options)), files_(files) {}

Result<std::unique_ptr<FilmLog>> FilmLog::open(const std::string& folder, const std::string& key,
                                               FilmLogOptions options) {
  if (key.empty() || key.size() > 1000 || key.find('\n') != std::string::npos) {
    return Error{"a film log's key is one line of text"};
  }
  LogFiles& files = options.files != nullptr ? *options.files : disk_log_files();
  std::unique_ptr<FilmLog> log(new FilmLog(folder, std::move(options), files));
  if (Status s = files.make_folder(folder); !s) return s.error();
  Result<std::unique_ptr<LogLock>> lock = files.lock(log->path(kLockName));
  if (!lock) return lock.error();
  log->lock_ = std::move(*lock);
  if (Status s = log->open_guard(key); !s) return s.error();
  if (log->options_.threaded) {
    auto thread = core::start_thread([self = log.get()] { self->commit_loop(); });
    if (!thread) return thread.error();
    log->thread_ = std::move(*thread);
  }
  return log;
}

/// Reads whose log this is, or says so in a new folder.
Status FilmLog::open_guard(const std::string& key) {
  Result<std::vector<std::string>> names = files_.list(folder_);
  if (!names) return names.error();
  const bool guarded = std::find(names->begin(), names->end(), kGuardName) != names->end();
  if (guarded) {
    const Result<std::string> text = read_whole(files_, path(kGuardName), 4096);
    if (!text) return text.error();
    std::istringstream lines(*text);
    std::string title;
    std::string holder;
    std::getline(lines, title);
    std::getline(lines, holder);
    lines >> salt_;
    if (title != kGuardTitle || !lines) {
      return Error{path(kGuardName) +
                   " is damaged or from a newer version of Hyades (it begins "
                   "with \"" +
                   title.substr(0, 40) + "\", expected \"" + kGuardTitle +
                   "\"): remove the folder or choose another one"};
    }
    if (holder == key) return {};
    return Error{folder_ + " holds the work of another job (its key is " + holder +
                 ", this job's is " + key + "): remove it or choose another folder"};
  }
  for (const std::string& name : *names) {
    if (parse_segment_name(name)) {
      return Error{folder_ + " holds films (" + name + ") but no " + kGuardName +
                   " that says whose: remove it or choose another folder"};
    }
  }
  std::random_device random;
  salt_ = options_.salt != 0 ? options_.salt : (uint64_t{random()} << 32U) | random();
  const std::string unfinished = path(kGuardName) + kUnfinishedSuffix;
  if (std::find(names->begin(), names->end(), std::string(kGuardName) + kUnfinishedSuffix) !=
      names->end()) {
    if (Status s = files_.remove(unfinished); !s) return s;
  }
  const std::string text = fmt::format("{}\n{}\n{}\n", kGuardTitle, key, salt_);
  if (Status s = write_whole(files_, unfinished, text); !s) return s;
  if (Status s = files_.rename(unfinished, path(kGuardName)); !s) return s;
  return files_.sync_folder(folder_);
}

FilmLog::~FilmLog() {
  {
    const core::MutexLock hold(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  if (thread_.joinable()) thread_.join();
}

Result<uint64_t> FilmLog::append(std::vector<std::byte> record) {
  if (record.empty() || record.size() > kMaxRecordBytes) {
    return Error{fmt::format("a record of {} bytes does not fit into the film log", record.size())};
  }
  const core::MutexLock hold(mutex_);
  if (!replayed_) return Error{"the film log has to be replayed before anything is appended"};
  if (pending_bytes_ > 0 && pending_bytes_ + record.size() > options_.max_pending_bytes) {
    return Error{fmt::format("{} MB wait to be written to {}{}", pending_bytes_ >> 20U, folder_,
                             failures_ > 0 ? ": " + last_failure_.message : std::string())};
  }
  pending_bytes_ += record.size();
  pending_.push_back({next_sequence_, std::move(record)});
  if (pending_.size() == 1 || pending_bytes_ >= kGroupBytes) work_.notify_one();
  return next_sequence_++;
}

Status FilmLog::sync() {
  uint64_t last = 0;
  {
    const core::MutexLock hold(mutex_);
    last = next_sequence_ - 1;
  }
  return wait(last);
}

Status FilmLog::wait(uint64_t sequence) {
  const core::MutexLock hold(mutex_);
  sequence = std::min(sequence, next_sequence_ - 1);
  urgent_ = std::max(urgent_, sequence);
  work_.notify_one();
  const uint64_t failures = failures_;
  while (durable_ < sequence && failures_ == failures) settled_.wait(mutex_);
  if (durable_ >= sequence) return {};
  return last_failure_;
}

uint64_t FilmLog::durable() const {
  const core::MutexLock hold(mutex_);
  return durable_;
}

Result<std::vector<std::byte>> FilmLog::read(const RecordPlace& place, bool& damaged) const {
  damaged = false;
  const std::string file = path(segment_name({place.segment, place.snapshot}));
  const Result<std::unique_ptr<LogReader>> reader = files_.open(file);
  if (!reader) return reader.error();
  std::vector<std::byte> payload;
  Status read = read_record(**reader, place.offset, salt_, payload, damaged);
  if (!read) return read.error().in(file);
  return payload;
}

void FilmLog::commit_loop() {
  using Clock = std::chrono::steady_clock;
  const core::MutexLock hold(mutex_);
  while (true) {
    while (!stopping_ && pending_.empty()) work_.wait(mutex_);
    if (pending_.empty()) return;
    const auto due = Clock::now() + options_.commit_delay;
    while (!stopping_ && urgent_ <= durable_ && pending_bytes_ < kGroupBytes &&
           Clock::now() < due) {
      work_.wait_until(mutex_, due);
    }
    if (commit_pending()) continue;
    if (stopping_) return;
    const auto again = Clock::now() + kRetryDelay;
    while (!stopping_ && urgent_ <= durable_ && Clock::now() < again) {
      work_.wait_until(mutex_, again);
    }
  }
}

/// Stores all that is pending, or puts it back, and tells those who wait; without the lock while it
/// does so.
Status FilmLog::commit_pending() {
  std::vector<Pending> group = std::move(pending_);
  pending_.clear();
  uint64_t bytes = 0;
  for (const Pending& record : group) bytes += record.bytes.size();
  const uint64_t through = group.back().sequence;
  mutex_.unlock();
  const Status stored = commit(group);
  mutex_.lock();

  if (stored) {
    durable_ = through;
    pending_bytes_ -= bytes;
  } else {
    group.insert(group.end(), std::make_move_iterator(pending_.begin()),
                 std::make_move_iterator(pending_.end()));
    pending_ = std::move(group);
    last_failure_ = stored.error();
    ++failures_;
    urgent_ = 0;
  }
  settled_.notify_all();
  if (stored ? options_.on_durable != nullptr : options_.on_trouble != nullptr) {
    mutex_.unlock();
    if (stored) {
      options_.on_durable(through);
    } else {
      options_.on_trouble(stored.error());
    }
    mutex_.lock();
  }
  return stored;
}

Status FilmLog::commit_now() {
  const core::MutexLock hold(mutex_);
  return pending_.empty() ? Status() : commit_pending();
}

Status FilmLog::commit(const std::vector<Pending>& group) {
  const core::MutexLock hold(files_mutex_);
  if (active_ && active_bytes_ >= options_.segment_bytes) active_.reset();
  if (!active_) {
    if (Status s = begin_segment(); !s) return s;
  }
  Status written = write_group(group);
  if (written) {
    segments_.back().last_sequence = group.back().sequence;
    return {};
  }
  // After a failed write or sync nobody knows what of the group will be there tomorrow, and a
  // second sync of the same file may say yes without having stored it. The file ends here, at what
  // is durable if it can be cut; the group goes into a new one, and replay drops doubles.
  active_.reset();
  Segment& given_up = segments_.back();
  if (!files_.truncate(path(given_up.name), active_bytes_)) {
    given_up.last_sequence = group.back().sequence;  // it may hold some of them
  } else if (active_bytes_ == kSegmentHeaderBytes && files_.remove(path(given_up.name))) {
    segments_.pop_back();  // a disk that stays full shall not fill up with empty files
  }
  return written;
}

Status FilmLog::begin_segment() {
  const SegmentName name{next_index_, false};
  const std::string file = path(segment_name(name));
  ++next_index_;
  Result<std::unique_ptr<LogWriter>> writer = files_.create(file);
  if (!writer) return writer.error();
  const auto header = encode_segment_header({kSegmentVersion, false, name.index, 0, salt_});
  Status stored = (*writer)->write(header);
  if (stored) stored = files_.sync_folder(folder_);
  if (!stored) {
    writer->reset();
    [[maybe_unused]] const Status removed = files_.remove(file);
    return stored;
  }
  active_ = std::move(*writer);
  active_bytes_ = kSegmentHeaderBytes;
  segments_.push_back({segment_name(name), name.index, 0, false});
  return {};
}

Status FilmLog::write_group(const std::vector<Pending>& group) {
  std::vector<std::byte> small;  // one write for many small records
  uint64_t bytes = 0;
  for (const Pending& record : group) {
    const auto header = encode_record_header(record.bytes, record.sequence, salt_);
    small.insert(small.end(), header.begin(), header.end());
    small.insert(small.end(), record.bytes.begin(), record.bytes.end());
    bytes += header.size() + record.bytes.size();
    if (small.size() >= kGroupBytes) {
      if (Status s = active_->write(small); !s) return s;
      small.clear();
    }
  }
  if (Status s = active_->write(small); !s) return s;
  core::failpoint("log-written");
  const auto begun = std::chrono::steady_clock::now();
  if (Status s = active_->sync(); !s) return s;
  if (options_.on_sync) options_.on_sync(std::chrono::steady_clock::now() - begun);
  core::failpoint("log-synced");
  active_bytes_ += bytes;
  return {};
}

}  // namespace hyades::coordinator
