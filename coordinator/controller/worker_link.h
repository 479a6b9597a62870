#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include "farm/message_bytes.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// The message as it goes over the wire: copies share its bytes.
inline grpc::ByteBuffer bytes_of(const v1::CoordinatorMessage& message) {
  grpc::ByteBuffer bytes;
  (void)farm::serialise(message, bytes);
  return bytes;
}

/// The coordinator's end of a worker's stream. Neither function blocks or calls back; both may be
/// called by any thread, after the stream has ended too.
class WorkerLink {
 public:
  virtual ~WorkerLink() = default;
  /// Messages arrive in the order of the calls.
  virtual void send(grpc::ByteBuffer message) = 0;
  /// Ends the stream once everything before is sent.
  virtual void close(const grpc::Status& status) = 0;
};

}  // namespace hyades::coordinator
