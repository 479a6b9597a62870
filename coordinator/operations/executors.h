#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <grpcpp/support/status.h>

#include "farm/thread_pool.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {

/// Where an operation runs.
enum class Runs {
  at_once,   ///< on the thread that it came by: it never waits
  in_store,  ///< where it may wait for the job store
  in_files,  ///< where it may wait for other files
};

/// The threads of a door that may wait for the disk: gRPC's own are few, and workers' heartbeats
/// and results come by them too; HTTP has one. Two pools, so that files on a disk that does not
/// answer leave those alone who only want to know something.
struct Executors {
  farm::ThreadPool store{4, 1000, 2};  ///< what is read from and stored in the job store
  farm::ThreadPool files{8, 1000, 4};  ///< what reads or writes files besides

  /// The pool for what runs so; null: none, it runs at once.
  farm::ThreadPool* of(Runs runs) {
    if (runs == Runs::at_once) return nullptr;
    return runs == Runs::in_store ? &store : &files;
  }
};

/// RESOURCE_EXHAUSTED: the pool's queue is full.
inline grpc::Status crowded() {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                           "more requests wait for the coordinator's disk than may",
                           std::chrono::seconds(2));
}

/// Why an answer is not given whose bytes would wait for their reader with too many others.
inline grpc::Status too_much_unread() {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                           "answers that are not read yet take as much as they may",
                           std::chrono::seconds(2));
}

/// Lets large requests be parsed one at a time, whether they came by gRPC or by HTTP: many of them
/// at once would fill the memory that both share. To be kept while one is parsed.
class LargeRequest {
 public:
  LargeRequest() = default;
  ~LargeRequest() {
    if (held_) taken_.clear();
  }
  LargeRequest(const LargeRequest&) = delete;
  LargeRequest& operator=(const LargeRequest&) = delete;

  /// For a request of so many bytes, until this goes. RESOURCE_EXHAUSTED where it is large, and
  /// another large one is being looked at; then it may be asked again.
  grpc::Status admit(uint64_t bytes) {
    if (bytes <= farm::kMaxRequestBytes) return grpc::Status::OK;
    held_ = !taken_.test_and_set();
    if (held_) return grpc::Status::OK;
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             "another large request is being looked at",
                             std::chrono::milliseconds(500));
  }

 private:
  inline static std::atomic_flag taken_;
  bool held_ = false;
};

}  // namespace hyades::coordinator
