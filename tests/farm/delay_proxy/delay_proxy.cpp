// usage: delay_proxy PORT HOST PORT-THERE LEAST-MS MOST-MS
// Passes TCP connections on, each piece of bytes late by a random time, in order. One thread; for
// tests.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <list>
#include <random>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
constexpr size_t kMostWaiting = size_t{4} << 20U;
constexpr size_t kPiece = size_t{64} << 10U;

/// One direction of a connection.
struct Flow {
  struct Piece {
    Clock::time_point due;
    std::string bytes;
  };
  int from = -1;
  int to = -1;
  std::deque<Piece> waiting{};
  size_t bytes = 0;
};

struct Connection {
  Flow there;
  Flow back;
  bool broken = false;
};

sockaddr_in address_of(const char* host, const char* port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(std::atoi(port)));
  if (inet_pton(AF_INET, host, &address.sin_addr) != 1) std::exit(2);
  return address;
}

bool receive(Flow& flow, Clock::time_point due) {
  std::string piece(kPiece, '\0');
  const ssize_t got = ::recv(flow.from, piece.data(), piece.size(), MSG_DONTWAIT);
  if (got <= 0) return false;
  piece.resize(static_cast<size_t>(got));
  if (!flow.waiting.empty()) due = std::max(due, flow.waiting.back().due);
  flow.bytes += piece.size();
  flow.waiting.push_back({due, std::move(piece)});
  return true;
}

bool deliver(Flow& flow) {
  std::string& piece = flow.waiting.front().bytes;
  const ssize_t sent = ::send(flow.to, piece.data(), piece.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0) return errno == EAGAIN;
  flow.bytes -= static_cast<size_t>(sent);
  piece.erase(0, static_cast<size_t>(sent));
  if (piece.empty()) flow.waiting.pop_front();
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: delay_proxy PORT HOST PORT-THERE LEAST-MS MOST-MS\n");
    return 2;
  }
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  const int yes = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in here = address_of("127.0.0.1", argv[1]);
  const sockaddr_in target = address_of(argv[2], argv[3]);
  if (::bind(listener, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0 ||
      ::listen(listener, 16) != 0) {
    std::perror("delay_proxy: listen");
    return 1;
  }
  std::mt19937 random{1};
  std::uniform_int_distribution<int> delay(std::atoi(argv[4]), std::atoi(argv[5]));
  std::list<Connection> connections;
  for (;;) {
    const Clock::time_point now = Clock::now();
    std::vector<pollfd> polled{{listener, POLLIN, 0}};
    std::vector<std::pair<Connection*, Flow*>> readers;
    bool busy = false;
    for (Connection& connection : connections) {
      for (Flow* flow : {&connection.there, &connection.back}) {
        while (!connection.broken && !flow->waiting.empty() && flow->waiting.front().due <= now) {
          const size_t before = flow->bytes;
          connection.broken = !deliver(*flow);
          if (flow->bytes == before) break;
        }
        busy = busy || !flow->waiting.empty();
        if (flow->bytes >= kMostWaiting) continue;
        polled.push_back({flow->from, POLLIN, 0});
        readers.emplace_back(&connection, flow);
      }
    }
    ::poll(polled.data(), polled.size(), busy ? 1 : 50);
    const Clock::time_point due = Clock::now() + std::chrono::milliseconds(delay(random));
    for (size_t i = 0; i < readers.size(); ++i) {
      if (polled[i + 1].revents == 0 || readers[i].first->broken) continue;
      if (!receive(*readers[i].second, due)) readers[i].first->broken = true;
    }
    connections.remove_if([](const Connection& connection) {
      if (!connection.broken) return false;
      ::close(connection.there.from);
      ::close(connection.there.to);
      return true;
    });
    if (polled[0].revents == 0) continue;
    const int caller = ::accept(listener, nullptr, nullptr);
    const int called = ::socket(AF_INET, SOCK_STREAM, 0);
    if (caller < 0 || called < 0 ||
        ::connect(called, reinterpret_cast<const sockaddr*>(&target), sizeof target) != 0) {
      if (caller >= 0) ::close(caller);
      if (called >= 0) ::close(called);
      continue;
    }
    for (const int socket : {caller, called}) {
      ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    }
    connections.push_back({{caller, called}, {called, caller}});
  }
}
