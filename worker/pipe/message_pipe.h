#pragma once

#include <google/protobuf/message_lite.h>

#include <mutex>
#include <vector>

#include "core/base/result.h"

namespace hyades::pipe {

/// Whole messages over a connected stream socket: four bytes of length (little-endian), then the
/// message. Owns the socket. One thread may receive while any number of threads send.
class MessagePipe {
 public:
  explicit MessagePipe(int fd) : fd_(fd) {}
  ~MessagePipe();
  MessagePipe(const MessagePipe&) = delete;
  MessagePipe& operator=(const MessagePipe&) = delete;

  /// Blocks while the other side does not read. Errors: it is gone.
  core::Status send(const google::protobuf::MessageLite& message);

  /// Blocks until a message is there; false where the other side has closed between two messages.
  /// Errors: it broke off within one, or what came is no such message.
  core::Result<bool> receive(google::protobuf::MessageLite& message);

  /// Ends all sends and receives, also of other threads, on both sides.
  void shut_down();

 private:
  int fd_;
  std::mutex send_mutex_;
  std::vector<char> received_;
};

}  // namespace hyades::pipe
