#include "tests/support/fake_viewer.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/base/descriptor.h"

namespace hyades::test {
namespace {

using Seen = FakeViewer::Seen;

/// The fields of a packet, one after the other; what is missing or too much is an exception.
class Fields {
 public:
  explicit Fields(const std::string& bytes) : bytes_(bytes) {}

  uint8_t byte() { return static_cast<uint8_t>(take(1)[0]); }
  bool flag() {
    const uint8_t value = byte();
    if (value > 1) throw std::runtime_error("a flag that is neither 0 nor 1");
    return value == 1;
  }
  int32_t number() { return static_cast<int32_t>(whole(4)); }
  int64_t large() { return static_cast<int64_t>(whole(8)); }
  std::string text() {
    const size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) throw std::runtime_error("a text without an end");
    const std::string found = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return found;
  }
  float value() {
    const auto bits = static_cast<uint32_t>(whole(4));
    float value = 0;
    std::memcpy(&value, &bits, 4);
    return value;
  }
  void end() const {
    if (at_ != bytes_.size()) throw std::runtime_error("bytes behind the last field");
  }

 private:
  std::string take(size_t count) {
    if (count > bytes_.size() - at_) throw std::runtime_error("a packet that is too short");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  uint64_t whole(size_t count) {
    const std::string taken = take(count);
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) {
      value |= static_cast<uint64_t>(static_cast<uint8_t>(taken[i])) << (8 * i);
    }
    return value;
  }

  const std::string& bytes_;
  size_t at_ = 0;
};

void create(Fields& fields, Seen& seen) {
  fields.flag();
  const std::string name = fields.text();
  FakeViewer::Picture& picture = seen.pictures[name];
  picture.width = fields.number();
  picture.height = fields.number();
  const int32_t channels = fields.number();
  if (picture.width < 1 || picture.height < 1 || channels < 1 || channels > 1000) {
    throw std::runtime_error("a picture of nothing");
  }
  picture.channels.clear();
  for (int32_t c = 0; c < channels; ++c) picture.channels.push_back(fields.text());
  if (std::set<std::string>(picture.channels.begin(), picture.channels.end()).size() !=
      picture.channels.size()) {
    throw std::runtime_error("two channels of one name");
  }
  fields.end();
  picture.values.assign(static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) *
                            static_cast<size_t>(channels),
                        0.0F);
  ++picture.created;
  seen.created.push_back(name);
}

void update(Fields& fields, Seen& seen) {
  fields.flag();
  const std::string name = fields.text();
  const auto found = seen.pictures.find(name);
  if (found == seen.pictures.end()) throw std::runtime_error("an update of no picture: " + name);
  FakeViewer::Picture& picture = found->second;
  const auto count = static_cast<size_t>(fields.number());
  if (count != picture.channels.size()) throw std::runtime_error("not all channels");
  for (size_t c = 0; c < count; ++c) {
    if (fields.text() != picture.channels[c]) throw std::runtime_error("another channel");
  }
  const int32_t x = fields.number();
  const int32_t y = fields.number();
  const int32_t width = fields.number();
  const int32_t height = fields.number();
  if (x < 0 || y < 0 || width < 1 || height < 1 || x + width > picture.width ||
      y + height > picture.height) {
    throw std::runtime_error("a part outside of the picture");
  }
  std::vector<int64_t> offsets(count);
  std::vector<int64_t> strides(count);
  for (int64_t& offset : offsets) offset = fields.large();
  for (int64_t& stride : strides) stride = fields.large();
  const int64_t pixels = int64_t{width} * height;
  int64_t all = 0;
  for (size_t c = 0; c < count; ++c) {
    if (offsets[c] < 0 || strides[c] < 1) throw std::runtime_error("values before the first");
    all = std::max(all, offsets[c] + (pixels - 1) * strides[c] + 1);
  }
  std::vector<float> values(static_cast<size_t>(all));
  for (float& value : values) value = fields.value();
  fields.end();
  for (int64_t pixel = 0; pixel < pixels; ++pixel) {
    const auto to =
        static_cast<size_t>(((y + pixel / width) * picture.width + x + pixel % width)) * count;
    for (size_t c = 0; c < count; ++c) {
      picture.values[to + c] = values[static_cast<size_t>(offsets[c] + pixel * strides[c])];
    }
  }
  ++picture.updates;
}

void take_packet(const std::string& packet, Seen& seen) {
  Fields fields(packet);
  fields.number();
  switch (const int operation = fields.byte()) {
    case 2: {
      const std::string name = fields.text();
      fields.end();
      if (seen.pictures.erase(name) == 0) throw std::runtime_error("closes no picture: " + name);
      seen.closed.push_back(name);
      return;
    }
    case 4:
      return create(fields, seen);
    case 6:
      return update(fields, seen);
    default:
      throw std::runtime_error("operation " + std::to_string(operation));
  }
}

core::Descriptor listen_on(int port, int& bound) {
  core::Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  socklen_t size = sizeof address;
  if (::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(socket.get(), 8) != 0 ||
      ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("no port to listen on");
  }
  bound = ntohs(address.sin_port);
  return socket;
}

}  // namespace

struct FakeViewer::State {
  int port = 0;
  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  Seen seen;
  std::atomic<bool> leaving{false};
  std::atomic<bool> reads{true};
  core::Descriptor listener;
  core::Descriptor connection;  ///< guarded by mutex; one at a time
  std::thread thread;

  void start(int wanted) {
    listener = listen_on(wanted, port);
    leaving = false;
    thread = std::thread([this] { run(); });
  }
  void stop() {
    leaving = true;
    if (thread.joinable()) thread.join();
    const std::lock_guard lock(mutex);
    listener.close();
    connection.close();
    seen.pictures.clear();
  }

  void run() {
    std::string buffer;
    while (!leaving) {
      pollfd looks[2] = {{listener.get(), POLLIN, 0}, {connection.get(), POLLIN, 0}};
      if (!reads) looks[1].fd = -1;
      if (::poll(looks, 2, 10) <= 0) continue;
      if ((looks[0].revents & POLLIN) != 0) {
        const std::lock_guard lock(mutex);
        connection = core::Descriptor(::accept(listener.get(), nullptr, nullptr));
        buffer.clear();
        ++seen.connections;
        changed.notify_all();
      } else if (looks[1].revents != 0) {
        char piece[65536];
        const ssize_t got = ::recv(connection.get(), piece, sizeof piece, MSG_DONTWAIT);
        const std::lock_guard lock(mutex);
        if (got <= 0) {
          if (!buffer.empty()) seen.wrong.emplace_back("the connection ends within a packet");
          connection.close();
        } else {
          seen.bytes += static_cast<uint64_t>(got);
          buffer.append(piece, static_cast<size_t>(got));
          take_packets(buffer);
        }
        changed.notify_all();
      }
    }
  }

  void take_packets(std::string& buffer) {
    while (buffer.size() >= 4) {
      uint32_t size = 0;
      std::memcpy(&size, buffer.data(), 4);
      if (size < 5) {
        seen.wrong.emplace_back("a packet of " + std::to_string(size) + " bytes");
        buffer.clear();
        return;
      }
      if (buffer.size() < size) return;
      try {
        take_packet(buffer.substr(0, size), seen);
      } catch (const std::exception& error) {
        seen.wrong.emplace_back(error.what());
      }
      buffer.erase(0, size);
    }
  }
};

FakeViewer::FakeViewer(int port) : state_(std::make_unique<State>()) { state_->start(port); }
FakeViewer::~FakeViewer() { state_->stop(); }

int FakeViewer::port() const { return state_->port; }
std::string FakeViewer::address() const { return "127.0.0.1:" + std::to_string(port()); }

void FakeViewer::leave() { state_->stop(); }
void FakeViewer::come_back() { state_->start(state_->port); }
void FakeViewer::stop_reading() { state_->reads = false; }
void FakeViewer::read_again() { state_->reads = true; }

void FakeViewer::babble(const std::string& bytes) {
  const std::lock_guard lock(state_->mutex);
  static_cast<void>(::send(state_->connection.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
}

Seen FakeViewer::seen() const {
  const std::lock_guard lock(state_->mutex);
  return state_->seen;
}

bool FakeViewer::wait_until(const std::function<bool(const Seen&)>& reached,
                            std::chrono::seconds limit) const {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, limit, [&] { return reached(state_->seen); });
}

int free_port() {
  int port = 0;
  listen_on(0, port);
  return port;
}

}  // namespace hyades::test
