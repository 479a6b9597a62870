#pragma once

#include <chrono>
#include <mutex>

#include <grpcpp/support/status.h>

#include "farm/thread_pool.h"
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

/// To be held while a large request is parsed, whether it came by gRPC or by HTTP: many of them at
/// once would fill the memory that both share. Holds nothing where somebody else holds it: then the
/// answer is another_is_large().
inline std::unique_lock<std::mutex> take_large_request() {
  static std::mutex large;
  return {large, std::try_to_lock};
}

/// RESOURCE_EXHAUSTED: another large request is being looked at.
inline grpc::Status another_is_large() {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                           "another large request is being looked at",
                           std::chrono::milliseconds(500));
}

}  // namespace hyades::coordinator
