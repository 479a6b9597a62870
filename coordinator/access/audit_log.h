#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "coordinator/access/rotating_log.h"
#include "core/base/descriptor.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/token_bucket.h"
#include "hyades/v1/admin.pb.h"

namespace hyades::coordinator {

/// What an audit log keeps, and where.
struct AuditOptions {
  std::string folder;                         ///< audit.jsonl, audit.1.jsonl (older), ...
  uint64_t most_bytes = uint64_t{16} << 20U;  ///< of a file; then the next one is begun
  int most_files = 10;                        ///< of actions; the oldest goes
  int most_of_others = 4;                     ///< of refusals, and of uploads
  size_t most_waiting = 10'000;  ///< lines of each kind that the disk has not taken yet
};

/// Who did what: lines of JSON that are only ever added to. Nobody who notes something waits: a
/// thread writes and syncs, within milliseconds where the disk answers. Thread-safe.
///
/// Actions, refusals (of actions that failed, too) and uploads have files and room of their own.
/// Any stranger can cause many refusals: neither these nor many uploads push out an action that
/// somebody needs to know of. Nor do many actions by one token.
class AuditLog {
 public:
  /// An error where the folder cannot be written to.
  static core::Result<std::unique_ptr<AuditLog>> open(const AuditOptions& options);
  /// All that was noted is written, if the disk takes it.
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  /// Something was done, or was tried by somebody who may. By one token that may not steer all jobs
  /// thousands are noted one by one, then one a second, which says how many it stands for; of what
  /// failed it is as with refuse().
  void note(const Caller& caller, const std::string& action, const std::string& target,
            const grpc::Status& result, const std::string& detail);
  /// Somebody may not. Of one address a few are noted one by one, then some every minute, which say
  /// how many they stand for. Of more than a thousand addresses all others count as one.
  void refuse(const Caller& caller, const std::string& action, const grpc::Status& why);
  /// Somebody begins to upload, or to go on with, the file of this digest.
  void upload(const Caller& caller, const std::string& action, const std::string& sha256,
              const std::string& detail);

  /// Waits until all that was noted is written; two seconds at most.
  void flush();

  /// Reads what is kept, the oldest first, as it was when this was made.
  class Reader {
   public:
    /// Nothing: that was all. Lines that are none of ours are passed over.
    std::optional<v1::AuditEntry> next();

   private:
    friend class AuditLog;
    /// The entries of one kind.
    struct Row {
      std::string log;                      ///< AuditEntry::log
      std::vector<core::Descriptor> files;  ///< the newest first
      std::string waiting;                  ///< bytes of the oldest that are not given yet
      size_t begin = 0;
      std::optional<v1::AuditEntry> head;  ///< nothing: that was all
      void step();
    };
    std::vector<Row> rows_;
  };
  Reader read() const;

 private:
  /// As they are written.
  enum Kind : uint8_t { kActions, kRefusals, kUploads, kKinds };

  /// Bounds how many entries of a neighbourhood or a token are noted one by one.
  struct RateLimit {
    farm::TokenBucket bucket;
    Kind kind = kActions;
    v1::AuditEntry held{};  ///< with `times` of those that were not noted
  };
  using Limits = std::map<std::string, RateLimit>;

  /// Lines of one kind that wait for the disk.
  struct Queue {
    std::deque<std::string> lines;
    uint64_t lost = 0;  ///< that found no room
    std::string last;   ///< audit_digest() of the last entry
    /// Adds the entry to the lines and to the chain.
    void append(v1::AuditEntry entry);
  };

  explicit AuditLog(const AuditOptions& options);
  void add(Kind kind, v1::AuditEntry entry) HYADES_REQUIRES(mutex_);
  void add_or_hold(RateLimit& limit, v1::AuditEntry entry) HYADES_REQUIRES(mutex_);
  void release_of(Limits& limits, bool all) HYADES_REQUIRES(mutex_);
  void release_held(bool all) HYADES_REQUIRES(mutex_);
  bool all_written() const HYADES_REQUIRES(mutex_);
  bool write_some(Kind kind) HYADES_REQUIRES(mutex_);
  void work();

  const size_t most_waiting_;
  std::array<RotatingLog, kKinds> logs_;  ///< written by the thread alone, once it runs

  mutable core::Mutex mutex_;
  std::array<Queue, kKinds> queues_ HYADES_GUARDED_BY(mutex_);
  Limits limits_ HYADES_GUARDED_BY(mutex_);      ///< of refusals, by neighbourhood_of() an address
  Limits failures_ HYADES_GUARDED_BY(mutex_);    ///< of actions that failed, by token
  Limits actions_of_ HYADES_GUARDED_BY(mutex_);  ///< of others, by token
  bool stop_ HYADES_GUARDED_BY(mutex_) = false;
  bool busy_ HYADES_GUARDED_BY(mutex_) = false;  ///< lines are on their way
  core::CondVar wake_;
  core::CondVar written_;
  std::thread thread_;
};

/// "ok", or the code in small letters.
std::string result_name(const grpc::Status& status);

}  // namespace hyades::coordinator
