#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::coordinator {

struct PostgresOptions;

/// The life of a job, as stored; the numbers are those of the file.
enum class StoredState : int { running = 1, paused = 2, done = 3, failed = 4, cancelled = 5 };

constexpr bool has_ended(StoredState state) { return state >= StoredState::done; }

/// A job as it is kept over restarts.
struct StoredJob {
  uint64_t id = 0;   ///< 0: not stored yet
  std::string key;   ///< the client's idempotency key, or empty
  std::string spec;  ///< v1::JobSpec, serialised: the store does not look into it
  std::string name;
  std::string owner;
  bool owner_proven = false;  ///< a token has shown who the owner is
  int priority = 0;
  /// What else was asked for: a v1::Job that holds nothing but that, serialised.
  std::string options;
  StoredState state = StoredState::running;
  uint32_t frames = 0;
  uint32_t frames_done = 0;
  uint32_t frames_failed = 0;
  uint64_t samples = 0;       ///< of all frames
  uint64_t samples_done = 0;  ///< when it ended
  int64_t submitted_ms = 0;
  int64_t begun_ms = 0;  ///< when its first unit was leased; 0: never, or it is not known
  uint64_t busy_ns = 0;  ///< in which it was worked on
  int64_t ended_ms = 0;
  std::string reason;
  uint64_t core_ns = 0;            ///< that threads took for the results which counted
  std::optional<int32_t> preview;  ///< the frame that stands for the job in a list
};

/// A job's spec alone.
struct StoredSpec {
  uint64_t id = 0;
  std::string spec;
};

/// A frame that is over. Others are not stored: their films tell.
struct StoredFrame {
  int32_t frame = 0;
  bool done = false;     ///< finished; else failed
  std::string reason{};  ///< why it failed
  std::string worker_class{};
  uint32_t restarts = 0;
  /// Who rendered a part of a finished frame on which nobody else agreed, by what workers call
  /// themselves (v1::Hello.worker_id); an empty name: somebody who is not known any more. It is not
  /// read again: mark_divergent() looks at it.
  std::vector<std::string> parts{};
  uint64_t moment = 0;   ///< when it was finished: greater than that of any frame before
  bool suspect = false;  ///< a worker that had a part in it was found divergent afterwards
  bool black = false;    ///< no light has reached any pixel of a finished frame
};

/// Workers of which it is kept when they could be trusted: the last ones.
inline constexpr size_t kMostTrusted = 10'000;

/// That a worker could be trusted at some moment (StoredFrame::moment): another one of its class
/// rendered a unit to the same bits.
struct StoredTrust {
  std::string worker;
  uint64_t moment = 0;
};

/// Finished frames of a job, in order.
struct SuspectFrames {
  uint64_t job = 0;
  std::vector<int32_t> frames;
};

/// A file that a finished frame has written.
struct StoredOutput {
  std::string path;  ///< below the job's output folder
  int32_t frame = 0;
  uint64_t size = 0;
  std::string sha256;   ///< 32 bytes
  uint64_t number = 0;  ///< grows in the order in which they were finished; the store gives it
};

/// A line of a job's history.
struct StoredLine {
  int64_t time_ms = 0;
  int level = 1;  ///< v1::LogLevel
  std::optional<int32_t> frame;
  std::string worker;
  std::string text;
  uint64_t number = 0;  ///< grows from line to line, with gaps; the store gives it
};

/// A worker that gets no units, over restarts of the coordinator too.
struct StoredQuarantine {
  std::string worker;  ///< what it calls itself (v1::Hello.worker_id)
  std::string reason;
};

/// What is known of a token: never the token itself.
struct StoredToken {
  std::string id;    ///< its public part
  std::string name;  ///< whose it is
  int role = 0;      ///< v1::Role
  std::string hash;  ///< SHA-256 of the token: 32 bytes
  int64_t created_ms = 0;
  int64_t expires_ms = 0;  ///< 0: never
  int64_t used_ms = 0;     ///< 0: never; may lag behind
  int64_t revoked_ms = 0;  ///< 0: it has not been
  std::string pool = {};   ///< of a worker's: all of one pool count as one witness; empty: none
  uint32_t machines = 0;   ///< of a worker's: how many workers may be here by it
};

/// A token's last use.
struct TokenUse {
  std::string id;
  int64_t used_ms = 0;
};

/// Rows that are read, or forgotten, in one call; others have their turn before the next.
inline constexpr uint32_t kRowsAtOnce = 1000;

/// The most lines that are kept of a job; the oldest go first, in groups of kLinesDropped.
inline constexpr uint64_t kMostLines = 50'000;
inline constexpr uint64_t kLinesDropped = 5'000;

/// What the coordinator keeps over restarts besides films and assets. What a function has written
/// is durable when it returns, log lines excepted, which may lag behind. Thread-safe.
class JobStore {
 public:
  virtual ~JobStore() = default;

  /// Counts a start of the coordinator: 1, 2, ...
  virtual core::Result<uint64_t> next_incarnation() = 0;
  /// 64 characters that nobody else has, the same for all starts: what coordinators of this store
  /// prove by that they have given something out.
  virtual core::Result<std::string> secret() = 0;

  /// What add_job() has done.
  struct Added {
    uint64_t id = 0;
    bool existed = false;  ///< it is that of a job with the same key
  };
  /// Stores a new job, unless one has the same (not empty) key already.
  virtual core::Result<Added> add_job(const StoredJob& job) = 0;
  /// The id of the job with this key; nothing where there is none.
  virtual core::Result<std::optional<uint64_t>> job_of_key(const std::string& key) = 0;
  /// Stores all of the job but its key, spec, name, owner and options, which never change.
  virtual core::Status update_job(const StoredJob& job) = 0;
  /// Forgets the job: it has no frames, outputs and lines any more for whoever asks. On the disk
  /// they stay until drop_removed() has been called often enough.
  virtual core::Status remove_job(uint64_t id) = 0;
  /// Drops what is left of jobs that were removed, `rows` rows at most. Whether there was something
  /// left, so that there may be more.
  virtual core::Result<bool> drop_removed(uint32_t rows) = 0;
  /// The ids of jobs that have not ended, oldest first.
  virtual core::Result<std::vector<uint64_t>> open_jobs() = 0;
  /// Nothing where there is no such job.
  virtual core::Result<std::optional<StoredJob>> job(uint64_t id) = 0;
  /// As job(), without its spec, which may have megabytes.
  virtual core::Result<std::optional<StoredJob>> summary(uint64_t id) = 0;
  /// Nothing where there is no such job.
  virtual core::Result<std::optional<StoredState>> state(uint64_t id) = 0;
  /// The specs of some jobs with ids above `after`, the oldest first: one at least where there is
  /// any, and no others once they have `most_bytes` together.
  virtual core::Result<std::vector<StoredSpec>> specs(uint64_t after, uint64_t most_bytes) = 0;
  /// Jobs with ids below `before` (0: all), the newest first, without their specs.
  virtual core::Result<std::vector<StoredJob>> list(bool ended, const std::string& owner,
                                                    uint64_t before, uint32_t limit) = 0;

  /// Nanoseconds that threads took for results of this owner's jobs since then, to the hour; also
  /// of jobs that are forgotten. What is older than a day may be.
  virtual core::Result<uint64_t> core_ns_of(const std::string& owner, int64_t since_ms) = 0;

  /// Replaces what is known of the frame, and of its outputs.
  virtual core::Status frame_over(uint64_t job, const StoredFrame& frame,
                                  const std::vector<StoredOutput>& outputs) = 0;
  /// The frames are to be rendered (again). All of it at once, or nothing.
  virtual core::Status forget_frames(uint64_t job, std::span<const int32_t> frames) = 0;
  /// So are all that have failed, however many; after an error some may be, and others not.
  virtual core::Status forget_failed_frames(uint64_t job) = 0;
  /// Forgets the job's outputs whose path is one of `gone`, or lies in that folder, and adds
  /// `made`. All of it at once, or nothing.
  virtual core::Status change_outputs(uint64_t job, const std::vector<std::string>& gone,
                                      const std::vector<StoredOutput>& made) = 0;
  /// The job's frames that are over, in order of their numbers: those above `after`, at most
  /// `limit`.
  virtual core::Result<std::vector<StoredFrame>> frames(uint64_t job, std::optional<int32_t> after,
                                                        uint32_t limit) = 0;
  /// All of the job's frames that are over.
  core::Result<std::vector<StoredFrame>> frames(uint64_t job) {
    return frames(job, std::nullopt, UINT32_MAX);
  }
  /// A frame's outputs, in the order of their paths.
  virtual core::Result<std::vector<StoredOutput>> outputs_of(uint64_t job, int32_t frame) = 0;
  /// The job's outputs in the order in which they were finished: those after number `after` (0:
  /// all), at most `limit`.
  virtual core::Result<std::vector<StoredOutput>> outputs(uint64_t job, uint64_t after,
                                                          uint32_t limit) = 0;
  /// The job's output with this path; nothing where there is none.
  virtual core::Result<std::optional<StoredOutput>> output(uint64_t job,
                                                           const std::string& path) = 0;

  /// Stores that the worker is in quarantine, and why; replaces an earlier reason.
  virtual core::Status quarantine(const StoredQuarantine& worker) = 0;
  /// Forgets the worker's quarantine; OK where there is none.
  virtual core::Status end_quarantine(const std::string& worker) = 0;
  /// All of them, in order of the workers' names.
  virtual core::Result<std::vector<StoredQuarantine>> quarantines() = 0;

  /// Stores when these workers could last be trusted; replaces earlier moments.
  virtual core::Status trust(const std::vector<StoredTrust>& workers) = 0;
  /// All workers of which that is kept.
  virtual core::Result<std::vector<StoredTrust>> trusted() = 0;
  /// The worker was found divergent, and is quarantined: all frames of all jobs, also of those that
  /// have ended, that were finished after `since` and that it had a part in, or may have had, are
  /// suspect from now on. Each job's log gets `line` (its text with the frames behind it). All of
  /// it at once, or nothing. Returns the frames that were not suspect before.
  virtual core::Result<std::vector<SuspectFrames>> mark_divergent(const StoredQuarantine& worker,
                                                                  uint64_t since,
                                                                  const StoredLine& line) = 0;
  /// Frames of the job that are suspect, in order, at most `limit`.
  virtual core::Result<std::vector<int32_t>> suspect_frames(uint64_t job, uint32_t limit) = 0;
  /// Frames of the job that are black, in order, at most `limit`.
  virtual core::Result<std::vector<int32_t>> black(uint64_t job, uint32_t limit) = 0;

  /// All tokens, also those that are of no use any more, the oldest first.
  virtual core::Result<std::vector<StoredToken>> tokens() = 0;
  /// An error where its id is there already.
  virtual core::Status add_token(const StoredToken& token) = 0;
  /// Stores that the token is revoked; it keeps its row, which tells whose it was.
  virtual core::Status revoke_token(const std::string& id, int64_t revoked_ms) = 0;
  /// Removes the token's row.
  virtual core::Status forget_token(const std::string& id) = 0;
  /// Stores when tokens were last used.
  virtual core::Status note_uses(const std::vector<TokenUse>& uses) = 0;

  /// Adds lines to the job's log. Where the oldest had to go, the first that is left says so.
  virtual core::Status add_lines(uint64_t job, const std::vector<StoredLine>& lines) = 0;
  /// The job's lines after number `after` (0: all), at most `limit`.
  virtual core::Result<std::vector<StoredLine>> lines(uint64_t job, uint64_t after,
                                                      uint32_t limit) = 0;
};

/// The store in a SQLite file (WAL, synchronous=FULL). A file of an older schema is brought to this
/// one, step by step, each in a transaction; one of a newer schema is refused.
core::Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::string& path);

/// The store in a PostgreSQL database, which prepare_postgres() (postgres_schema.h) has seen, for
/// the coordinator that leads: tables of an older schema are brought to this one, and its
/// next_incarnation() is that of `options`, which its lease has given out.
core::Result<std::unique_ptr<JobStore>> open_postgres_job_store(const PostgresOptions& options);

}  // namespace hyades::coordinator
