#include "tests/coordinator/hostile/raw_http2.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "farm/wire.h"

namespace hyades::test {
namespace {

constexpr uint8_t kData = 0;
constexpr uint8_t kHeaders = 1;
constexpr uint8_t kReset = 3;
constexpr uint8_t kSettings = 4;
constexpr uint8_t kPing = 6;
constexpr uint8_t kGoAway = 7;
constexpr uint8_t kWindowUpdate = 8;
constexpr uint8_t kAck = 1;
constexpr uint8_t kEndStream = 1;
constexpr uint8_t kEndHeaders = 4;
constexpr uint16_t kInitialWindowSize = 4;
constexpr size_t kFrameHead = 9;
constexpr size_t kMostInFrame = 16'384;

std::string big_endian(uint32_t value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += static_cast<char>(value >> (8 * i));
  return out;
}

uint32_t from_big_endian(std::string_view bytes) {
  uint32_t value = 0;
  for (const char c : bytes) value = value << 8U | static_cast<uint8_t>(c);
  return value;
}

/// A header that no table knows, without Huffman's code (RFC 7541, section 6.2.2).
std::string literal(const std::string& name, const std::string& value) {
  std::string out(1, '\0');
  out += static_cast<char>(name.size());
  out += name;
  out += static_cast<char>(value.size());
  out += value;
  return out;
}

}  // namespace

RawHttp2::RawHttp2(const std::string& address, bool talk, const std::string& from)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in own{};
  own.sin_family = AF_INET;
  ::inet_pton(AF_INET, from.c_str(), &own.sin_addr);
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  if (!talk) return;
  write("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n");
  frame(kSettings, 0, 0, {});
}

RawHttp2::~RawHttp2() { ::close(socket_); }

void RawHttp2::open_windows() {
  frame(kSettings, 0, 0, big_endian(kInitialWindowSize, 2) + big_endian(0x7FFFFFFF, 4));
  frame(kWindowUpdate, 0, 0, big_endian(0x7FFF0000, 4));
}

uint32_t RawHttp2::call(const std::string& path,
                        const std::vector<std::pair<std::string, std::string>>& headers) {
  const uint32_t id = next_;
  next_ += 2;
  std::string block = literal(":method", "POST") + literal(":scheme", "http") +
                      literal(":path", path) + literal(":authority", "farm") +
                      literal("content-type", "application/grpc") + literal("te", "trailers") +
                      literal("hyades-protocol", std::to_string(farm::kProtocol));
  for (const auto& [name, value] : headers) block += literal(name, value);
  windows_[id] = initial_window_;
  ended_[id] = false;
  frame(kHeaders, kEndHeaders, id, block);
  return id;
}

uint64_t RawHttp2::endless_headers(uint64_t most) {
  constexpr uint8_t kContinuation = 9;
  const uint32_t id = next_;
  next_ += 2;
  std::string block;
  while (block.size() < 8'000) block += literal(std::string(100, 'x'), std::string(100, 'y'));
  uint64_t sent = 0;
  for (uint8_t type = kHeaders; sent < most && connected_; type = kContinuation) {
    frame(type, 0, id, block);
    sent += block.size();
    read(0);
  }
  return sent;
}

uint64_t RawHttp2::broken_calls(const std::string& path, uint64_t most,
                                const std::vector<std::pair<std::string, std::string>>& headers) {
  uint64_t sent = 0;
  while (sent < most && connected_) {
    const uint32_t id = call(path, headers);
    frame(kReset, 0, id, big_endian(8, 4));
    sent += 200;
    read(0);
  }
  return sent;
}

uint64_t RawHttp2::send(uint32_t call, std::string_view bytes) {
  uint64_t sent = 0;
  int waits = 0;
  while (sent < bytes.size() && connected_ && !ended_[call] && waits < 5) {
    const int64_t room = std::min({windows_[call], window_, int64_t{kMostInFrame}});
    if (room <= 0) {
      read(100);
      ++waits;
      continue;
    }
    waits = 0;
    const std::string_view piece = bytes.substr(sent, static_cast<size_t>(room));
    frame(kData, 0, call, piece);
    sent += piece.size();
    window_ -= static_cast<int64_t>(piece.size());
    windows_[call] -= static_cast<int64_t>(piece.size());
    read(0);
  }
  return sent;
}

void RawHttp2::finish(uint32_t call) { frame(kData, kEndStream, call, {}); }

bool RawHttp2::ended(uint32_t call, int milliseconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
  while (connected_ && !ended_[call] && std::chrono::steady_clock::now() < until) read(10);
  return !connected_ || ended_[call];
}

bool RawHttp2::greeted(int milliseconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
  while (connected_ && !greeted_ && std::chrono::steady_clock::now() < until) read(10);
  return greeted_;
}

bool RawHttp2::closed(int milliseconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
  while (connected_ && std::chrono::steady_clock::now() < until) read(10);
  return !connected_;
}

std::string RawHttp2::head(uint32_t length, bool packed) {
  return std::string(1, packed ? '\1' : '\0') + big_endian(length, 4);
}

void RawHttp2::write(std::string_view bytes) {
  while (!bytes.empty() && connected_) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    connected_ = count > 0;
    if (connected_) bytes.remove_prefix(static_cast<size_t>(count));
  }
}

void RawHttp2::frame(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload) {
  std::string bytes = big_endian(static_cast<uint32_t>(payload.size()), 3);
  bytes += static_cast<char>(type);
  bytes += static_cast<char>(flags);
  bytes += big_endian(stream, 4);
  bytes += payload;
  write(bytes);
}

void RawHttp2::read(int milliseconds) {
  pollfd ready{socket_, POLLIN, 0};
  if (!connected_ || ::poll(&ready, 1, milliseconds) <= 0) return;
  std::array<char, 65'536> buffer{};
  const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (count <= 0) {
    connected_ = false;
    return;
  }
  incoming_.append(buffer.data(), static_cast<size_t>(count));
  std::string_view rest = incoming_;
  while (rest.size() >= kFrameHead) {
    const size_t size = from_big_endian(rest.substr(0, 3));
    if (rest.size() < kFrameHead + size) break;
    take(static_cast<uint8_t>(rest[3]), static_cast<uint8_t>(rest[4]),
         from_big_endian(rest.substr(5, 4)) & 0x7FFFFFFFU, rest.substr(kFrameHead, size));
    rest.remove_prefix(kFrameHead + size);
  }
  incoming_.erase(0, incoming_.size() - rest.size());
}

void RawHttp2::take(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload) {
  if (type == kSettings && (flags & kAck) == 0) {
    for (; payload.size() >= 6; payload.remove_prefix(6)) {
      if (from_big_endian(payload.substr(0, 2)) != kInitialWindowSize) continue;
      const int64_t size = from_big_endian(payload.substr(2, 4));
      for (auto& [id, window] : windows_) window += size - initial_window_;
      initial_window_ = size;
    }
    frame(kSettings, kAck, 0, {});
    greeted_ = true;
  } else if (type == kPing && (flags & kAck) == 0) {
    frame(kPing, kAck, 0, payload);
  } else if (type == kWindowUpdate) {
    (stream == 0 ? window_ : windows_[stream]) += from_big_endian(payload);
  } else if (type == kReset || ((type == kHeaders || type == kData) && (flags & kEndStream) != 0)) {
    ended_[stream] = true;
  } else if (type == kGoAway) {
    for (auto& [id, over] : ended_) over = true;
  }
}

}  // namespace hyades::test
