#include "worker/pipe/message_pipe.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

namespace hyades::pipe {
namespace {

/// No film is larger; a length beyond means that the two sides have lost step.
constexpr uint32_t kMaxMessage = uint32_t{1} << 30U;

core::Error gone(const char* what) { return {std::string(what) + ": " + std::strerror(errno)}; }

/// How many bytes came before the end of the stream.
core::Result<size_t> read_all(int fd, char* to, size_t size) {
  size_t have = 0;
  while (have < size) {
    const ssize_t count = ::recv(fd, to + have, size - have, 0);
    if (count == 0) break;
    if (count < 0) {
      if (errno == EINTR) continue;
      return gone("the pipe cannot be read");
    }
    have += static_cast<size_t>(count);
  }
  return have;
}

}  // namespace

MessagePipe::~MessagePipe() { ::close(fd_); }

core::Status MessagePipe::send(const google::protobuf::MessageLite& message) {
  const size_t size = message.ByteSizeLong();
  if (size > kMaxMessage) return core::Error{"a message is too long for the pipe"};
  std::vector<char> bytes(4 + size);
  for (size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(size >> (8 * i));
  message.SerializeWithCachedSizesToArray(reinterpret_cast<uint8_t*>(bytes.data() + 4));
  const std::lock_guard lock(send_mutex_);
  for (size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count < 0) {
      if (errno == EINTR) continue;
      return gone("the pipe cannot be written");
    }
    sent += static_cast<size_t>(count);
  }
  return {};
}

core::Result<bool> MessagePipe::receive(google::protobuf::MessageLite& message) {
  std::array<char, 4> head{};
  auto count = read_all(fd_, head.data(), head.size());
  if (!count) return count.error();
  if (*count == 0) return false;
  uint32_t size = 0;
  for (size_t i = 0; i < 4; ++i) {
    size |= uint32_t{static_cast<uint8_t>(head[i])} << (8 * i);
  }
  if (*count < head.size() || size > kMaxMessage) return core::Error{"the pipe is out of step"};
  received_.resize(size);
  count = read_all(fd_, received_.data(), size);
  if (!count) return count.error();
  if (*count < size) return core::Error{"the pipe broke off within a message"};
  if (!message.ParseFromArray(received_.data(), static_cast<int>(size))) {
    return core::Error{"the pipe brought something that is no message"};
  }
  return true;
}

void MessagePipe::shut_down() { ::shutdown(fd_, SHUT_RDWR); }

}  // namespace hyades::pipe
