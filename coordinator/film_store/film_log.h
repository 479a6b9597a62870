#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/film_store/log_files.h"
#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

struct SegmentHeader;

struct FilmLogOptions {
  /// How long the first record of a group waits for others before all are synced together.
  std::chrono::microseconds commit_delay{3000};
  uint64_t segment_bytes = uint64_t{64} << 20U;       ///< a new file is begun past this size
  uint64_t max_pending_bytes = uint64_t{256} << 20U;  ///< append() refuses beyond

  /// Called by the commit thread: all records up to `through` are durable now.
  std::function<void(uint64_t through)> on_durable;
  /// Called by the commit thread when a group could not be stored (disk full, ...). The group is
  /// kept in memory and tried again, in a new file.
  std::function<void(const core::Error& error)> on_trouble;

  /// Called by the commit thread: so long took the disk to make a group durable.
  std::function<void(std::chrono::nanoseconds took)> on_sync;

  LogFiles* files = nullptr;  ///< the disk where null

  // For simulations, which have to be the same every time.

  bool threaded = true;  ///< else nothing is stored but by commit_now(), and at the end nothing
  uint64_t salt = 0;     ///< of a new log's checksums; 0: a random one
};

/// Where a record of a log stands, until the log is compacted.
struct RecordPlace {
  uint64_t segment = 0;  ///< its index
  bool snapshot = false;
  uint64_t offset = 0;  ///< of the record's header
};

/// What replay() found. Damage costs rendering again, never a wrong picture.
struct ReplayReport {
  uint64_t records = 0;               ///< given to the visitor and accepted
  uint64_t bytes = 0;                 ///< their payload
  uint64_t torn_bytes = 0;            ///< cut off the end of the last file: never acknowledged
  uint64_t damaged_bytes = 0;         ///< skipped elsewhere
  std::vector<std::string> problems;  ///< in words: damaged places, records the visitor refused
};

/// An append-only, checksummed log of records (films) that survives kill -9 and loss of power: what
/// it called durable is there again after a restart. Records are numbered 1, 2, ...
/// A background thread writes and syncs them in groups, every few milliseconds. The log is a folder
/// of segment files; docs/film-log.md describes them. One process at a time; thread-safe within.
///
/// Use: open, replay (once), then append from any thread; acknowledge a record when it is durable.
class FilmLog {
 public:
  /// Takes a record that was stored; an error refuses it.
  using Visitor = std::function<core::Status(std::span<const std::byte> record)>;
  /// Stores a record of a snapshot.
  using Sink = std::function<core::Status(std::span<const std::byte> record)>;

  /// Opens or creates the log in `folder` for the job `key` (one line of text, e.g. the hash of
  /// what decides its pixels). Refused where the folder holds another job's log or another process
  /// uses it.
  static core::Result<std::unique_ptr<FilmLog>> open(const std::string& folder,
                                                     const std::string& key,
                                                     FilmLogOptions options = {});

  /// Stores what is pending, if it can, and lets go of the folder.
  ~FilmLog();
  FilmLog(const FilmLog&) = delete;
  FilmLog& operator=(const FilmLog&) = delete;

  /// Gives every stored record to `visitor`: the newest snapshot's first, then those appended
  /// since, in order. Stops at a torn tail and cuts it off; skips damaged records by searching for
  /// the next whole one, and reports both. A record that the visitor refuses is reported and
  /// skipped too. To be called once, before the first append. Fails only where the folder, or
  /// for now a file in it (LogReader::passing_trouble), cannot be read, or was written by a newer
  /// version.
  core::Result<ReplayReport> replay(const Visitor& visitor);

  /// Where the record stands that replay() gives to its visitor, or that the sink of compact() has
  /// just taken.
  const RecordPlace& place() const { return place_; }

  /// Reads the record at `place` again. `damaged`: it is there no more as it was written; else it
  /// may be read another time.
  core::Result<std::vector<std::byte>> read(const RecordPlace& place, bool& damaged) const;

  /// Queues a record (1 byte to kMaxRecordBytes) and returns its number; durable later. Refused
  /// when more than max_pending_bytes wait (the disk is full or too slow).
  core::Result<uint64_t> append(std::vector<std::byte> record);

  /// Waits until all records appended so far are durable; an error where an attempt to store them
  /// has failed meanwhile (they are kept and tried again).
  core::Status sync();

  /// Waits until the records up to `sequence` are durable; an error where an attempt to store them
  /// has failed meanwhile (they are kept and tried again).
  core::Status wait(uint64_t sequence);

  /// All records up to this number are durable.
  uint64_t durable() const;

  /// Where the log has no thread: stores what is pending now, as the thread would, once.
  core::Status commit_now();

  /// Replaces all records up to number `through` (which must be durable) by those that `write` puts
  /// into its sink, atomically: a crash leaves the old ones or the new ones. Appending goes on
  /// meanwhile; records after `through` stay. Returns when it is durable. `replaced` is called when
  /// the new ones stand, before the old ones go; whether or not these can be removed.
  core::Status compact(uint64_t through, const std::function<core::Status(const Sink&)>& write,
                       const std::function<void()>& replaced = {});

  static constexpr uint64_t kMaxRecordBytes = uint64_t{1} << 31U;

 private:
  struct Replay;
  struct Pending {
    uint64_t sequence = 0;
    std::vector<std::byte> bytes;
  };
  struct Segment {
    std::string name;
    uint64_t index = 0;
    uint64_t last_sequence = 0;
    bool snapshot = false;
  };

  FilmLog(std::string folder, FilmLogOptions options, LogFiles& files);

  core::Status open_guard(const std::string& key);
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  core::Result<std::vector<Segment>> find_segments();
  core::Result<std::optional<SegmentHeader>> read_header(const Segment& segment);
  core::Status find_newest_snapshot(const std::vector<Segment>& found, Replay& state);
  std::vector<Segment> replay_segments(const std::vector<Segment>& found, Replay& state);
  bool replay_segment(Segment& segment, bool last, Replay& state);
  core::Status write_snapshot(const std::string& file, uint64_t index, uint64_t through,
                              const std::function<core::Status(const Sink&)>& write);
  core::Status remove_segments(const std::function<bool(const Segment&)>& superseded)
      HYADES_REQUIRES(files_mutex_);
  void commit_loop();
  core::Status commit_pending() HYADES_REQUIRES(mutex_);
  core::Status commit(const std::vector<Pending>& group);
  core::Status begin_segment() HYADES_REQUIRES(files_mutex_);
  core::Status write_group(const std::vector<Pending>& group) HYADES_REQUIRES(files_mutex_);

  const std::string folder_;
  const FilmLogOptions options_;
  LogFiles& files_;
  std::unique_ptr<LogLock> lock_;
  uint64_t salt_ = 0;
  RecordPlace place_;

  /// What appending threads share with the commit thread.
  mutable core::Mutex mutex_;
  core::CondVar work_;     ///< for the commit thread
  core::CondVar settled_;  ///< for those who wait for durability
  std::vector<Pending> pending_ HYADES_GUARDED_BY(mutex_);
  uint64_t pending_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  uint64_t next_sequence_ HYADES_GUARDED_BY(mutex_) = 1;
  uint64_t durable_ HYADES_GUARDED_BY(mutex_) = 0;
  uint64_t urgent_ HYADES_GUARDED_BY(mutex_) = 0;  ///< somebody waits for this number: no delay
  uint64_t failures_ HYADES_GUARDED_BY(mutex_) = 0;
  core::Error last_failure_ HYADES_GUARDED_BY(mutex_);
  bool replayed_ HYADES_GUARDED_BY(mutex_) = false;
  bool stopping_ HYADES_GUARDED_BY(mutex_) = false;

  /// The files, of the commit thread and of compact().
  core::Mutex files_mutex_;
  std::vector<Segment> segments_ HYADES_GUARDED_BY(files_mutex_);
  std::unique_ptr<LogWriter> active_
      HYADES_GUARDED_BY(files_mutex_);  ///< the end of segments_.back(), or null
  uint64_t active_bytes_ HYADES_GUARDED_BY(files_mutex_) = 0;  ///< of which all are durable
  uint64_t next_index_ HYADES_GUARDED_BY(files_mutex_) = 1;

  core::Mutex compact_mutex_;  ///< one compaction at a time
  std::thread thread_;
};

/// Removes the log in `folder` (its own files only), so that another job can use it. Refused while
/// a process uses it.
core::Status erase_film_log(const std::string& folder, LogFiles* files = nullptr);

}  // namespace hyades::coordinator
