#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"
#include "hyades/v1/admin.pb.h"

namespace hyades::coordinator {

/// What an audit log keeps, and where.
struct AuditOptions {
  std::string folder;                         ///< audit.jsonl, audit.1.jsonl (older), ...
  uint64_t most_bytes = uint64_t{16} << 20U;  ///< of a file; then the next one is begun
  int most_files = 10;                        ///< the oldest goes
};

/// Who did what: lines of JSON that are only ever added to. Nobody who notes something waits: a
/// thread writes and syncs, within milliseconds where the disk answers. Thread-safe.
class AuditLog {
 public:
  /// An error where the folder cannot be written to.
  static core::Result<std::unique_ptr<AuditLog>> open(AuditOptions options);
  /// All that was noted is written, if the disk takes it.
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  /// Something was done, or was tried by somebody who may.
  void note(const Caller& caller, const std::string& deed, const std::string& target,
            const grpc::Status& result, const std::string& detail);
  /// Somebody may not. Of one address a few are noted one by one, then some every minute, which say
  /// how many they stand for.
  void refuse(const Caller& caller, const std::string& deed, const grpc::Status& why);

  /// Waits until all that was noted is written; two seconds at most.
  void flush();

  /// Reads what is kept, the oldest first, as it was when this was made.
  class Reader {
   public:
    /// Nothing: that was all. Lines that are none of ours are passed over.
    std::optional<v1::AuditEntry> next();

   private:
    friend class AuditLog;
    std::vector<core::Descriptor> files_;  ///< the newest first
    std::string waiting_;                  ///< bytes of the oldest that are not given yet
    size_t begin_ = 0;
  };
  Reader read() const;

 private:
  /// How many refusals of an address are noted as they come.
  struct Purse {
    double left = 0;
    std::chrono::steady_clock::time_point since;
    v1::AuditEntry held;  ///< with `times` of those that were not noted
  };

  explicit AuditLog(AuditOptions options) : options_(std::move(options)) {}
  std::string path(int number) const;
  core::Status open_file();
  void add(v1::AuditEntry entry);
  void release_held(bool all);
  bool write(const std::string& lines);
  void rotate();
  void work();

  const AuditOptions options_;
  core::Descriptor file_;  ///< of the thread alone, once it runs
  uint64_t size_ = 0;

  mutable std::mutex mutex_;
  std::deque<std::string> queue_;
  uint64_t lost_ = 0;  ///< that found no room in the queue
  std::map<std::string, Purse> purses_;
  bool stop_ = false;
  bool busy_ = false;  ///< lines are on their way
  std::condition_variable wake_;
  std::condition_variable written_;
  std::thread thread_;
};

/// "ok", or the code in small letters.
std::string result_name(const grpc::Status& status);

}  // namespace hyades::coordinator
