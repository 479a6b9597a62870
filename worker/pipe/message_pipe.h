#pragma once

#include <google/protobuf/message_lite.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::pipe {

/// The most bytes that are taken in. A message unpacks into up to thirty times its bytes, a load
/// takes what it is: what may be long travels as a load.
struct PipeLimits {
  uint32_t message = uint32_t{1} << 20U;
  uint32_t load = 0;
};

/// `size` bytes to `to`; how many came before the end.
using ReadBytes = std::function<size_t(char* to, size_t size)>;

/// One message and its load; false where the bytes end before its end. Memory is taken for what
/// comes, not for what is announced. Errors: longer than `limits`, no such message.
core::Result<bool> read_message(const ReadBytes& read, const PipeLimits& limits,
                                google::protobuf::MessageLite& message, std::string& load);

/// The bytes that read_message() reads.
std::string frame_message(const google::protobuf::MessageLite& message, std::string_view load = {});

/// Whole messages over a connected stream socket: four bytes of the message's length
/// (little-endian), four of its load's, then the message, then the load: any bytes that belong to
/// it. Owns the socket. One thread may receive while any number of threads send.
class MessagePipe {
 public:
  /// `limits`: of what is received.
  MessagePipe(int fd, const PipeLimits& limits) : fd_(fd), limits_(limits) {}
  ~MessagePipe();
  MessagePipe(const MessagePipe&) = delete;
  MessagePipe& operator=(const MessagePipe&) = delete;

  /// Blocks while the other side does not read. Errors: it is gone.
  core::Status send(const google::protobuf::MessageLite& message, std::string_view load = {})
      HYADES_EXCLUDES(send_mutex_);

  /// Blocks until a message is there; false where the other side is gone, be it within a message.
  /// Errors as read_message() has them.
  core::Result<bool> receive(google::protobuf::MessageLite& message, std::string& load);

  /// Ends all sends and receives, also of other threads, on both sides.
  void shut_down();

 private:
  core::Status send_all(std::string_view bytes) HYADES_REQUIRES(send_mutex_);

  const int fd_;
  const PipeLimits limits_;
  core::Mutex send_mutex_;  ///< of who writes to the socket
};

}  // namespace hyades::pipe
