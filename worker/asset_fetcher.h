#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "farm/backoff.h"
#include "farm/content_store.h"
#include "hyades/v1/common.pb.h"

namespace grpc {
class Channel;
class ClientContext;
}  // namespace grpc

namespace hyades::worker {

/// Brings the files of jobs into the cache: those of a job one after the other, those of a few jobs
/// at the same time, so that a file that does not come holds up nobody else. What has come of a
/// file stays when the connection breaks. Thread-safe.
class AssetFetcher {
 public:
  /// Called from the fetching threads; must not block.
  class Owner {
   public:
    virtual ~Owner() = default;
    virtual void files_are_there(uint64_t job) = 0;
    /// `final`: trying again here, or elsewhere, gives the same. Trouble of the cache never is.
    virtual void files_failed(uint64_t job, const std::string& reason, bool final) = 0;
  };

  /// `store` and `owner` outlive the fetcher. A coordinator that cannot be reached is tried again
  /// for `patience`, a cache that takes no file for some seconds.
  AssetFetcher(std::shared_ptr<grpc::Channel> channel, std::string token, farm::ContentStore& store,
               Owner& owner, std::chrono::milliseconds patience);
  /// Breaks off what is being fetched.
  ~AssetFetcher();
  AssetFetcher(const AssetFetcher&) = delete;
  AssetFetcher& operator=(const AssetFetcher&) = delete;

  /// Of downloads that begin from now on.
  void set_token(std::string token);

  /// All files of the job, which are then kept from eviction until release().
  void fetch(uint64_t job, const v1::JobSpec& spec);
  /// Somebody has found this file of the store damaged: before it counts as there again it is
  /// hashed.
  void doubt(const std::string& file);
  /// The job's files are no longer wanted: what is under way is broken off and not reported.
  void release(uint64_t job);

  /// Bytes of the store's files, as of the last time that a job's files were fetched.
  uint64_t cache_bytes() const { return cache_bytes_; }
  /// Files of jobs so far that were there when they were needed, and those that had to be fetched.
  uint64_t hits() const { return hits_; }
  uint64_t misses() const { return misses_; }

 private:
  /// The files of a job. What changes is guarded by mutex_.
  struct Wanted {
    uint64_t job = 0;
    v1::JobSpec spec;
    bool dropped = false;                 ///< it was released meanwhile
    grpc::ClientContext* call = nullptr;  ///< the download in progress
  };
  /// Of a file: nobody else fetches it meanwhile.
  class Turn;
  struct Failure {
    std::string reason;
    bool final = false;
    bool again = false;                        ///< the same may succeed soon
    bool local = false;                        ///< the trouble is this machine's
    std::chrono::milliseconds retry_after{0};  ///< what the coordinator asked for
  };
  using Outcome = std::optional<Failure>;

  void loop();
  Outcome fetch_all(Wanted& wanted);
  Outcome fetch_file(Wanted& wanted, const v1::JobFile& file);
  void settle_doubts(const std::string& name);
  static Failure local_trouble(const core::Error& error);
  Outcome fetch_patiently(Wanted& wanted, const v1::JobFile& file);
  Outcome download(Wanted& wanted, const v1::JobFile& file);
  bool pause(const Wanted& wanted, farm::Backoff::Duration time);
  bool unwanted(const Wanted& wanted) const { return stop_ || wanted.dropped; }

  const std::shared_ptr<grpc::Channel> channel_;
  farm::ContentStore& store_;
  Owner& owner_;
  const std::chrono::milliseconds patience_;

  std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  std::string token_;
  std::deque<std::shared_ptr<Wanted>> wanted_;    ///< those that nobody has begun with
  std::vector<std::shared_ptr<Wanted>> in_work_;  ///< one for each busy thread
  std::set<std::string> turns_;                   ///< files that are being fetched
  std::set<std::string> doubted_;                 ///< files that doubt() has named
  std::map<uint64_t, std::vector<farm::ContentPin>> pins_;
  bool stop_ = false;

  std::atomic<uint64_t> cache_bytes_;
  std::atomic<uint64_t> hits_{0};
  std::atomic<uint64_t> misses_{0};

  std::vector<std::thread> threads_;
};

}  // namespace hyades::worker
