#include "worker/pipe/message_pipe.h"
#include "core/base/posix_file.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace hyades::pipe {
namespace {

constexpr size_t kHead = 8;
/// Memory is taken in such pieces, when those before are filled.
constexpr size_t kPiece = size_t{1} << 20U;

std::string head_of(size_t message, size_t load) {
  std::string head(kHead, '\0');
  for (size_t i = 0; i < 4; ++i) {
    head[i] = static_cast<char>(message >> (8 * i));
    head[4 + i] = static_cast<char>(load >> (8 * i));
  }
  return head;
}

uint32_t number_at(const char* bytes) {
  uint32_t number = 0;
  for (size_t i = 0; i < 4; ++i) {
    number |= uint32_t{static_cast<uint8_t>(bytes[i])} << (8 * i);
  }
  return number;
}

/// False where the bytes end before.
bool read_whole(const ReadBytes& read, size_t size, std::string& to) {
  to.clear();
  while (to.size() < size) {
    const size_t have = to.size();
    const size_t piece = std::min(kPiece, size - have);
    to.resize(have + piece);
    if (read(to.data() + have, piece) < piece) return false;
  }
  return true;
}

}  // namespace

core::Result<bool> read_message(const ReadBytes& read, const PipeLimits& limits,
                                google::protobuf::MessageLite& message, std::string& load) {
  std::array<char, kHead> head{};
  if (read(head.data(), head.size()) < head.size()) return false;
  const uint32_t size = number_at(head.data());
  const uint32_t load_size = number_at(head.data() + 4);
  if (size > limits.message || load_size > limits.load) {
    return core::Error{"sent more than any message has"};
  }
  std::string bytes;
  if (!read_whole(read, size, bytes) || !read_whole(read, load_size, load)) return false;
  if (!message.ParseFromString(bytes)) return core::Error{"sent what is no message"};
  return true;
}

std::string frame_message(const google::protobuf::MessageLite& message, std::string_view load) {
  const std::string bytes = message.SerializeAsString();
  return head_of(bytes.size(), load.size()) + bytes + std::string(load);
}

MessagePipe::~MessagePipe() { ::close(fd_); }

core::Status MessagePipe::send_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        core::uninterrupted([&] { return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL); });
    if (count < 0) {
      return core::Error{std::string("the pipe cannot be written: ") + std::strerror(errno)};
    }
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  return {};
}

core::Status MessagePipe::send(const google::protobuf::MessageLite& message,
                               std::string_view load) {
  if (message.ByteSizeLong() > UINT32_MAX || load.size() > UINT32_MAX) {
    return core::Error{"a message is too long for the pipe"};
  }
  std::string bytes = head_of(message.ByteSizeLong(), load.size());
  message.AppendToString(&bytes);
  const core::MutexLock lock(send_mutex_);
  if (auto sent = send_all(bytes); !sent) return sent;
  return send_all(load);
}

core::Result<bool> MessagePipe::receive(google::protobuf::MessageLite& message, std::string& load) {
  const auto read = [this](char* to, size_t size) {
    size_t have = 0;
    while (have < size) {
      const ssize_t count =
          core::uninterrupted([&] { return ::recv(fd_, to + have, size - have, 0); });
      if (count <= 0) break;
      have += static_cast<size_t>(count);
    }
    return have;
  };
  return read_message(read, limits_, message, load);
}

void MessagePipe::shut_down() { ::shutdown(fd_, SHUT_RDWR); }

}  // namespace hyades::pipe
