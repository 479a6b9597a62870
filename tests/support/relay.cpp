#include "tests/support/relay.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace hyades::test {
namespace {

constexpr int kLookMs = 10;

core::Descriptor new_socket() {
  return core::Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// What has come at one end goes to the other; false where the connection is over.
bool pass_on(int from, int to) {
  std::array<char, 65536> piece{};
  const ssize_t got = ::recv(from, piece.data(), piece.size(), MSG_DONTWAIT);
  if (got <= 0) return false;
  for (ssize_t sent = 0; sent < got;) {
    const ssize_t more =
        ::send(to, piece.data() + sent, static_cast<size_t>(got - sent), MSG_NOSIGNAL);
    if (more <= 0) return false;
    sent += more;
  }
  return true;
}

}  // namespace

Relay::Relay(const std::string& there)
    : there_(std::atoi(there.substr(there.rfind(':') + 1).c_str())),
      frozen_(there.empty()),
      listening_(new_socket()) {
  const sockaddr_in any = loopback(0);
  (void)::bind(listening_.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any);
  (void)::listen(listening_.get(), 100);
  thread_ = std::thread([this] { run(); });
}

Relay::~Relay() {
  end_ = true;
  thread_.join();
}

std::string Relay::address() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(listening_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

void Relay::run() {
  while (!end_) {
    if (frozen_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kLookMs));
      continue;
    }
    std::vector<pollfd> looked{{listening_.get(), POLLIN, 0}};
    for (const Pair& pair : pairs_) {
      for (const core::Descriptor& end : pair.ends) looked.push_back({end.get(), POLLIN, 0});
    }
    (void)::poll(looked.data(), looked.size(), kLookMs);
    if (frozen_) continue;
    for (size_t i = pairs_.size(); i-- > 0;) {
      bool well = true;
      for (size_t end = 0; end < 2; ++end) {
        if (looked[1 + 2 * i + end].revents == 0) continue;
        well = well && pass_on(pairs_[i].ends[end].get(), pairs_[i].ends[1 - end].get());
      }
      if (!well) pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (looked[0].revents != 0) take();
  }
}

void Relay::take() {
  core::Descriptor here(::accept4(listening_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  core::Descriptor there = new_socket();
  const sockaddr_in to = loopback(there_);
  if (!here.valid() ||
      ::connect(there.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    return;
  }
  pairs_.push_back({{std::move(here), std::move(there)}});
}

}  // namespace hyades::test
