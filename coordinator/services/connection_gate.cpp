#include "coordinator/services/connection_gate.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "coordinator/access/address.h"
#include "coordinator/access/peer_user.h"
#include "coordinator/services/memory_trim.h"
#include "coordinator/services/receive_bound.h"

namespace hyades::coordinator {
namespace {

/// What the kernel tells of, besides connections: being woken, and listeners from the first on.
constexpr uint64_t kWoken = 0;
constexpr uint64_t kFirstListener = 1;
constexpr uint64_t kFirstConnection = 1000;

constexpr size_t kEventsAtOnce = 256;
/// Connections that are accepted before it is looked whose time has come.
constexpr int kAcceptsAtOnce = 64;
constexpr std::chrono::milliseconds kAcceptAgainAfter{200};
constexpr int kLongestWaitMs = 60'000;
/// How long what was sent may stay without an answer of the other machine.
constexpr unsigned kAnswersWithinMs = 10'000;

/// Of the files that this process may have open, those who wait get an eighth; and of what is known
/// each needs two, where two thirds are left to all of it.
ConnectionGate::Limits within_open_files(ConnectionGate::Limits limits) {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur == RLIM_INFINITY) return limits;
  limits.strangers.waiting = std::min<size_t>(limits.strangers.waiting, files.rlim_cur / 8);
  limits.known = std::min<size_t>(limits.known, files.rlim_cur / 3);
  return limits;
}

std::string address_of(const sockaddr_storage& from) {
  std::array<char, INET6_ADDRSTRLEN> host{};
  if (from.ss_family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(from);
    ::inet_ntop(AF_INET, &four.sin_addr, host.data(), host.size());
    return address_text(host.data(), std::to_string(ntohs(four.sin_port)));
  }
  const auto& six = reinterpret_cast<const sockaddr_in6&>(from);
  ::inet_ntop(AF_INET6, &six.sin6_addr, host.data(), host.size());
  return address_text(host.data(), std::to_string(ntohs(six.sin6_port)));
}

bool watch(const core::Descriptor& poll, int operation, const core::Descriptor& file,
           uint32_t events, uint64_t id) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = id;
  return ::epoll_ctl(poll.get(), operation, file.get(), &event) == 0;
}

/// What a machine's own token counts as, besides the one that it joined with; empty: it is none.
std::string machine_key(const std::string& token_id, const std::string& machine) {
  return machine.empty() ? std::string() : token_id + '\n' + machine;
}

bool is_out_of_files(int error) {
  return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
}

}  // namespace

ConnectionGate::ConnectionGate(const Limits& limits)
    : limits_(within_open_files(limits)),
      strangers_(limits_.strangers),
      next_id_(kFirstConnection) {}

core::Status ConnectionGate::open(Listening listening, Inside inside) {
  listening_ = std::move(listening);
  inside_ = std::move(inside);
  poll_ = core::Descriptor(::epoll_create1(EPOLL_CLOEXEC));
  wake_ = core::Descriptor(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  bool watched =
      poll_.valid() && wake_.valid() && watch(poll_, EPOLL_CTL_ADD, wake_, EPOLLIN, kWoken);
  beginnings_are_kept_ = true;
  for (size_t i = 0; i < listening_.sockets.size(); ++i) {
    const core::Descriptor& socket = listening_.sockets[i];
    // Those who connect get their options from here.
    (void)::setsockopt(socket.get(), IPPROTO_TCP, TCP_USER_TIMEOUT, &kAnswersWithinMs,
                       sizeof kAnswersWithinMs);
    beginnings_are_kept_ = keep_beginnings(socket) && beginnings_are_kept_;
    watched = watched && watch(poll_, EPOLL_CTL_ADD, socket, EPOLLIN, kFirstListener + i);
  }
  if (!watched) {
    return core::Error{"cannot watch connections (" +
                       std::error_code(errno, std::generic_category()).message() + ")"};
  }
  thread_ = std::thread([this] { run(); });
  return {};
}

void ConnectionGate::close() {
  {
    const core::MutexLock lock(mutex_);
    stop_ = true;
  }
  if (thread_.joinable()) {
    wake();
    thread_.join();
  }
  const core::MutexLock lock(mutex_);
  for (const auto& [id, connection] : connections_) strangers_.leave(id);
  connections_.clear();
  by_address_.clear();
  known_ = 0;
  known_by_.clear();
  listening_.sockets.clear();
}

void ConnectionGate::mark_known(const std::string& address, const std::string& token_id,
                                const std::string& machine) {
  const core::MutexLock lock(mutex_);
  const auto found = by_address_.find(address);
  if (found == by_address_.end()) return;
  const Id id = found->second;
  Connection& connection = connections_.at(id);
  connection.calls = 0;
  if (connection.known) return;
  strangers_.know(id, token_id, std::chrono::steady_clock::now());
  const std::string key = machine_key(token_id, machine);
  if (has_place_for(token_id, key)) {
    connection.known = true;
    connection.token_id = token_id;
    connection.machine = key;
    lift_bound(connection.socket);
    ++known_;
    ++known_by_[token_id];
    if (!key.empty()) ++known_by_[key];
  } else {
    drop(id);
  }
  if (strangers_.waiting() > 0) wake();
}

void ConnectionGate::mark_unknown(const std::string& address) {
  const core::MutexLock lock(mutex_);
  const auto found = by_address_.find(address);
  if (found == by_address_.end()) return;
  Connection& connection = connections_.at(found->second);
  if (++connection.calls < limits_.stranger_calls) return;
  drop(found->second);
  wake();
}

std::string ConnectionGate::own_end_to(const std::string& address) const {
  const core::MutexLock lock(mutex_);
  const auto found = by_address_.find(address);
  return found == by_address_.end() ? "" : own_end(connections_.at(found->second).socket.get());
}

void ConnectionGate::note_begun(const std::string& address) {
  const core::MutexLock lock(mutex_);
  const auto found = by_address_.find(address);
  if (found == by_address_.end()) return;
  const Id id = found->second;
  if (++connections_.at(id).open_calls > limits_.open_calls) shut_out(id);
}

void ConnectionGate::note_over(const std::string& address, bool broken) {
  const core::MutexLock lock(mutex_);
  const auto found = by_address_.find(address);
  if (found == by_address_.end()) return;
  const Id id = found->second;
  Connection& connection = connections_.at(id);
  connection.open_calls = std::max(connection.open_calls - 1, 0);
  if (!broken || !connection.known) return;  // of a stranger bytes are bounded
  const Time now = std::chrono::steady_clock::now();
  if (!connection.broken) {
    connection.broken.emplace(limits_.broken_calls, limits_.broken_calls_per_second, now);
  }
  if (!connection.broken->take(now)) shut_out(id);
}

/// Ends the connection of one who costs too much, and lets what he came in by rest: of all machines
/// that joined with a token only himself.
void ConnectionGate::shut_out(Id id) {
  const Time now = std::chrono::steady_clock::now();
  const Connection& connection = connections_.at(id);
  const std::string& whose = connection.machine.empty() ? connection.token_id : connection.machine;
  std::erase_if(resting_, [&](const auto& other) { return other.second <= now; });
  if (!whose.empty()) resting_[whose] = now + limits_.broken_rest;
  drop(id);
  wake();
}

bool ConnectionGate::rests(const std::string& whose) const {
  const auto until = resting_.find(whose);
  return until != resting_.end() && std::chrono::steady_clock::now() < until->second;
}

size_t ConnectionGate::count_of(const std::string& whose) const {
  const auto own = known_by_.find(whose);
  return own == known_by_.end() ? 0 : own->second;
}

void ConnectionGate::forget_one_of(const std::string& whose) {
  const auto own = known_by_.find(whose);
  if (--own->second == 0) known_by_.erase(own);
}

bool ConnectionGate::has_place_for(const std::string& token_id, const std::string& machine) const {
  const size_t free = limits_.known - known_;
  if (free == 0 || rests(token_id) || rests(machine)) return false;
  if (token_id.empty()) return true;
  return count_of(token_id) < free && (machine.empty() || count_of(machine) < (free + 3) / 4);
}

ConnectionGate::Count ConnectionGate::count() const {
  const core::MutexLock lock(mutex_);
  return {strangers_.waiting(), strangers_.inside(), known_};
}

void ConnectionGate::run() {
  std::array<epoll_event, kEventsAtOnce> events{};
  MemoryTrim memory;
  for (;;) {
    int patience = 0;
    {
      const core::MutexLock lock(mutex_);
      if (stop_) return;
      patience = milliseconds_to_wait();
    }
    const int count = ::epoll_wait(poll_.get(), events.data(), kEventsAtOnce, patience);
    std::vector<int> entering;
    bool trim = false;
    {
      const core::MutexLock lock(mutex_);
      const Time now = std::chrono::steady_clock::now();
      for (int i = 0; i < count; ++i) hear(events[i].data.u64, events[i].events, now);
      advance(now, entering);
      trim = trim_again_ <= now;
      if (trim) trim_again_ = now + limits_.trim_every;
    }
    // Without the lock: what comes in may call, and so be known, before this returns.
    for (const int socket : entering) inside_(socket);
    if (trim) memory.look();
  }
}

int ConnectionGate::milliseconds_to_wait() const {
  const std::optional<Time> next = strangers_.next_expiry();
  Time first = trim_again_;
  if (strangers_.inside() > 0) first = std::min(first, look_again_);
  for (const std::optional<Time>& other : {next, accept_again_}) {
    if (other) first = std::min(first, *other);
  }
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(first - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp<int64_t>(left.count(), 0, kLongestWaitMs));
}

void ConnectionGate::hear(Id id, uint32_t events, Time now) {
  if (id == kWoken) {
    uint64_t times = 0;
    (void)!::read(wake_.get(), &times, sizeof times);
  } else if (id < kFirstConnection) {
    accept_from(listening_.sockets[id - kFirstListener], now);
  } else if ((events & (EPOLLHUP | EPOLLRDHUP)) != 0) {
    // A farm's machines stay for days, and may all come back at once.
    const auto found = connections_.find(id);
    if (found != connections_.end() && found->second.known && found->second.calls == 0 &&
        !found->second.neighbourhood.empty()) {
      strangers_.trust(found->second.neighbourhood, found->second.token_id, now);
    }
    drop(id);  // both sides have ended it, or one who waited has gone
  }
}

void ConnectionGate::accept_from(const core::Descriptor& listener, Time now) {
  for (int i = 0; i < kAcceptsAtOnce; ++i) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    core::Descriptor socket(::accept4(listener.get(), reinterpret_cast<sockaddr*>(&from), &size,
                                      SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket.valid()) {
      take(std::move(socket), address_of(from));
    } else if (is_out_of_files(errno)) {
      watch_listeners(false);
      accept_again_ = now + kAcceptAgainAfter;
      return;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      return;
    }
    // Else that one has gone already.
  }
}

void ConnectionGate::watch_listeners(bool watched) const {
  for (size_t i = 0; i < listening_.sockets.size(); ++i) {
    (void)watch(poll_, EPOLL_CTL_MOD, listening_.sockets[i], watched ? uint32_t{EPOLLIN} : 0U,
                kFirstListener + i);
  }
}

/// Whether calls of another connection from there, perhaps a stranger's, could be taken for those
/// of a new one: it has just been inside, or is there still, at another address of ours.
bool ConnectionGate::may_be_mistaken(const std::string& address) const {
  if (const auto left = left_.find(address);
      left != left_.end() && std::chrono::steady_clock::now() < left->second) {
    return true;
  }
  const auto before = by_address_.find(address);
  if (before == by_address_.end()) return false;
  const Connection& connection = connections_.at(before->second);
  return !connection.known || !own_end(connection.socket.get()).empty();
}

void ConnectionGate::take(core::Descriptor socket, std::string address) {
  if (may_be_mistaken(address)) return;  // a client comes again, from another port
  const Neighbour neighbour = neighbour_at(address, socket.get());
  Connection connection{.socket = std::move(socket),
                        .address = std::move(address),
                        .neighbourhood = neighbour.is_own_user ? std::string() : neighbour.name};
  if (beginnings_are_kept_) {
    // Else nobody could bound what this one sends; a client comes again.
    const std::optional<uint32_t> beginning = take_beginning(connection.socket);
    if (!beginning) return;
    connection.beginning = beginning;
    connection.bound = limits_.stranger_bytes_at_once;
    bound_received(connection.socket, *beginning, connection.bound);
  }
  const Id id = next_id_++;
  if (!watch(poll_, EPOLL_CTL_ADD, connection.socket, EPOLLRDHUP | EPOLLET, id)) return;
  strangers_.come(id, neighbour.name, neighbour.is_own_user, neighbour.group);
  by_address_[connection.address] = id;  // one before it from there was known, and is ending
  connections_.emplace(id, std::move(connection));
}

/// Whose time has come goes, and who may comes in: what they come in by is put into `entering`.
void ConnectionGate::advance(Time now, std::vector<int>& entering) {
  if (accept_again_ && *accept_again_ <= now) {
    accept_again_.reset();
    watch_listeners(true);
  }
  for (const Id id : strangers_.expel(now)) drop(id);
  look_at_strangers(now);
  while (const auto id = strangers_.let_in(now)) {
    if (const int socket = enter(*id); socket >= 0) entering.push_back(socket);
  }
  while (const auto id = strangers_.turn_away()) drop(*id);
}

/// The socket by which this one comes in; -1 where he cannot, and is gone.
int ConnectionGate::enter(Id id) {
  const core::Descriptor& own = connections_.at(id).socket;
  // It came before there was a bound, and has cost nothing yet.
  if (bytes_received(own) >= limits_.stranger_bytes) {
    drop(id);
    return -1;
  }
  const int socket = ::fcntl(own.get(), F_DUPFD_CLOEXEC, 0);
  // From here on others read, and only the end of both sides is of interest.
  if (socket < 0 || !watch(poll_, EPOLL_CTL_MOD, own, EPOLLET, id)) {
    if (socket >= 0) ::close(socket);
    drop(id);
    return -1;
  }
  connections_.at(id).entered = true;
  return socket;
}

/// Ends a connection, whoever else holds its socket, and forgets it.
void ConnectionGate::drop(Id id) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  Connection& connection = found->second;
  if (connection.known) {
    --known_;
    forget_one_of(connection.token_id);
    if (!connection.machine.empty()) forget_one_of(connection.machine);
  }
  const Time now = std::chrono::steady_clock::now();
  strangers_.go(id, now);
  if (connection.entered && !connection.known) {
    left_[connection.address] = now + limits_.address_rest;
  }
  const auto address = by_address_.find(connection.address);
  if (address != by_address_.end() && address->second == id) by_address_.erase(address);
  (void)::shutdown(connection.socket.get(), SHUT_RDWR);
  // Or the kernel would not even tell the other side that nobody takes what it sends.
  lift_bound(connection.socket);
  // The kernel goes on watching what is open inside.
  (void)::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, connection.socket.get(), nullptr);
  connections_.erase(found);
}

/// Lets more of strangers inside in, and ends those that have sent more than they need to say who
/// they are. Where the kernel bounds nothing this is the only bound, as quick as a busy machine
/// lets it be.
void ConnectionGate::look_at_strangers(Time now) {
  if (now < look_again_) return;
  look_again_ = now + limits_.stranger_pace;
  std::erase_if(left_, [&](const auto& one) { return one.second <= now; });
  for (const Id id : strangers_.all_inside()) {
    Connection& connection = connections_.at(id);
    const uint64_t received = bytes_received(connection.socket);
    if (received >= limits_.stranger_bytes) {
      drop(id);
    } else if (connection.beginning && received >= connection.bound) {
      connection.bound =
          std::min(connection.bound + limits_.stranger_bytes_at_once, limits_.stranger_bytes);
      bound_received(connection.socket, *connection.beginning, connection.bound);
    }
  }
}

void ConnectionGate::wake() const {
  const uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);
}

}  // namespace hyades::coordinator
