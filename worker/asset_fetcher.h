#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/base/hash.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/backoff.h"
#include "farm/channels.h"
#include "farm/content_store.h"
#include "hyades/v1/common.pb.h"
#include "worker/files_trouble.h"

namespace grpc {
class ClientContext;
}

namespace hyades::worker {

/// Brings the files of jobs into the cache: those of a job one after the other, those of a few jobs
/// at the same time, so that a file that does not come holds up nobody else. What has come of a
/// file stays when the connection breaks. Thread-safe.
class AssetFetcher {
 public:
  /// Called from the fetching threads; must not block.
  class Listener {
   public:
    virtual ~Listener() = default;
    virtual void files_are_there(uint64_t job) = 0;
    virtual void files_failed(uint64_t job, const std::string& reason, FilesTrouble trouble) = 0;
  };

  /// `store` and `listener` outlive the fetcher. It asks at the current one of `channels`; which
  /// one that is others say, who see the coordinator's whole stream. A coordinator that cannot be
  /// reached is tried again for `patience`, a cache that takes no file for some seconds.
  AssetFetcher(std::shared_ptr<farm::Channels> channels, std::string token,
               farm::ContentStore& store, Listener& listener, std::chrono::milliseconds patience);
  /// Breaks off what is being fetched.
  ~AssetFetcher();
  AssetFetcher(const AssetFetcher&) = delete;
  AssetFetcher& operator=(const AssetFetcher&) = delete;

  /// Of downloads that begin from now on.
  void set_token(std::string token) HYADES_EXCLUDES(mutex_);

  /// All files of the job, which are then kept from eviction until release().
  void fetch(uint64_t job, const v1::JobSpec& spec) HYADES_EXCLUDES(mutex_);
  /// Somebody has found this file of the store damaged: before it counts as there again it is
  /// hashed.
  void recheck(const std::string& file) HYADES_EXCLUDES(mutex_);
  /// The job's files are no longer wanted: what is under way is broken off and not reported.
  void release(uint64_t job) HYADES_EXCLUDES(mutex_);
  /// Whether all files of the job were fetched and not released since, whatever is reported late.
  bool has_files(uint64_t job) HYADES_EXCLUDES(mutex_);

  /// Bytes of the store's files, as of the last time that a job's files were fetched.
  uint64_t cache_bytes() const { return cache_bytes_; }
  /// Files of jobs so far that were there when they were needed, and those that had to be fetched.
  uint64_t hits() const { return hits_; }
  uint64_t misses() const { return misses_; }

 private:
  /// The files of a job.
  struct Wanted {
    uint64_t job = 0;
    std::string spec;                     ///< a v1::JobSpec as it travels: few are read at once
    bool dropped = false;                 ///< with mutex_: it was released meanwhile
    grpc::ClientContext* call = nullptr;  ///< with mutex_: the download in progress
  };
  /// Of a file: nobody else fetches it meanwhile.
  class FileClaim;
  /// A file that jobs have, or will have, in work: open once, for all of them.
  struct Kept {
    size_t jobs = 0;
    std::optional<farm::ContentPin> pin;
  };
  using Digests = std::vector<core::Sha256>;  ///< of a job's files, none twice
  struct Failure {
    std::string reason;
    FilesTrouble trouble = FilesTrouble::job;
    bool again = false;                        ///< the same may succeed soon
    bool local = false;                        ///< of this machine's cache
    std::chrono::milliseconds retry_after{0};  ///< what the coordinator asked for
  };
  using Outcome = std::optional<Failure>;

  void loop() HYADES_EXCLUDES(mutex_);
  Outcome fetch_all(Wanted& wanted) HYADES_EXCLUDES(mutex_);
  Outcome keep(const Digests& files) HYADES_EXCLUDES(mutex_);
  std::vector<farm::ContentPin> let_go(const Digests& files) HYADES_REQUIRES(mutex_);
  Outcome fetch_each(Wanted& wanted, const v1::JobSpec& spec) HYADES_EXCLUDES(mutex_);
  Outcome fetch_file(Wanted& wanted, const v1::JobFile& file) HYADES_EXCLUDES(mutex_);
  void check_again(const std::string& name) HYADES_EXCLUDES(mutex_);
  static Failure local_trouble(const core::Error& error, FilesTrouble trouble);
  Outcome fetch_patiently(Wanted& wanted, const v1::JobFile& file) HYADES_EXCLUDES(mutex_);
  Outcome download(Wanted& wanted, const v1::JobFile& file) HYADES_EXCLUDES(mutex_);
  bool pause(const Wanted& wanted, farm::Backoff::Duration time) HYADES_EXCLUDES(mutex_);
  bool unwanted(const Wanted& wanted) const HYADES_REQUIRES(mutex_) {
    return stop_ || wanted.dropped;
  }

  const std::shared_ptr<farm::Channels> channels_;
  farm::ContentStore& store_;
  Listener& listener_;
  const std::chrono::milliseconds patience_;
  const size_t most_pins_;  ///< each is an open file

  core::Mutex mutex_;
  core::CondVar wake_;
  std::string token_ HYADES_GUARDED_BY(mutex_);
  /// Those that nobody has begun with.
  std::deque<std::shared_ptr<Wanted>> wanted_ HYADES_GUARDED_BY(mutex_);
  /// One for each busy thread.
  std::vector<std::shared_ptr<Wanted>> in_work_ HYADES_GUARDED_BY(mutex_);
  std::set<std::string> claimed_ HYADES_GUARDED_BY(mutex_);      ///< files that are being fetched
  std::set<std::string> to_recheck_ HYADES_GUARDED_BY(mutex_);   ///< files that recheck() has named
  std::map<core::Sha256, Kept> kept_ HYADES_GUARDED_BY(mutex_);  ///< no more than most_pins_
  std::map<uint64_t, Digests> pinned_ HYADES_GUARDED_BY(mutex_);  ///< by job: files of these
  bool stop_ HYADES_GUARDED_BY(mutex_) = false;

  std::atomic<uint64_t> cache_bytes_;
  std::atomic<uint64_t> hits_{0};
  std::atomic<uint64_t> misses_{0};

  std::vector<std::thread> threads_;
};

}  // namespace hyades::worker
