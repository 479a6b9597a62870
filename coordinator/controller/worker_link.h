#pragma once

#include <grpcpp/support/status.h>

#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// The coordinator's end of a worker's stream. Neither function blocks or calls back; both may be
/// called by any thread, after the stream has ended too.
class WorkerLink {
 public:
  virtual ~WorkerLink() = default;
  /// Messages arrive in the order of the calls.
  virtual void send(v1::CoordinatorMessage message) = 0;
  /// Ends the stream once everything before is sent.
  virtual void close(const grpc::Status& status) = 0;
};

}  // namespace hyades::coordinator
