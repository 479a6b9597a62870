#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "coordinator/access/listening.h"
#include "coordinator/services/stranger_queue.h"
#include "core/base/descriptor.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/token_bucket.h"

namespace hyades::coordinator {

/// Stands before gRPC, for which a connection costs much more than for the kernel: takes
/// connections, and hands few at a time on. Whoever comes is a stranger until mark_known() is told
/// of them: strangers may be inside for a short time, and in small numbers (StrangerQueue); those
/// beyond wait outside as bare sockets, of which nothing is read. A thread of its own does it.
class ConnectionGate {
 public:
  struct Limits {
    StrangerQueue::Limits strangers{};
    /// What of a stranger is let in at once, and how often as much again of who has sent that: a
    /// handshake, and the first call's headers. gRPC keeps what calls cost that are reset at once,
    /// twenty kilobytes each, until it comes to them, and headers that do not end. Who has sent
    /// `stranger_bytes` goes.
    uint32_t stranger_bytes = uint32_t{16} << 10U;
    uint32_t stranger_bytes_at_once = uint32_t{4} << 10U;
    std::chrono::milliseconds stranger_pace{250};
    /// Calls in a row without a token that is one, after which somebody goes: a stranger, or who
    /// was known by a token that is revoked since.
    int stranger_calls = 8;
    /// Calls that one who is known may break off at once, and how many more each second; and how
    /// many of his may be in work. gRPC takes any number at once that are broken off, and keeps
    /// twenty kilobytes of each until it comes to it. Who has more goes, and nobody comes in by the
    /// token for a while; where that is one machine's own, by that.
    double broken_calls = 100;
    double broken_calls_per_second = 5;
    int open_calls = 400;
    std::chrono::seconds broken_rest{10};
    /// Connections of those that are known; also bounded by the files that may be open. With one
    /// token as many as are free at most, so half of them, and then who has another comes in; with
    /// one machine's own a quarter of that.
    size_t known = 20'000;
    /// For how long nobody is taken from the address of a stranger who was inside and has gone:
    /// gRPC tells calls by their address alone, and may only now come to his.
    std::chrono::milliseconds address_rest{5000};
    /// How often it is looked whether memory can be given back to the system.
    std::chrono::milliseconds trim_every{15'000};
  };
  /// Takes a connected socket over, which does not block.
  using Inside = std::function<void(int socket)>;

  explicit ConnectionGate(const Limits& limits);
  ~ConnectionGate() { close(); }
  ConnectionGate(const ConnectionGate&) = delete;
  ConnectionGate& operator=(const ConnectionGate&) = delete;

  /// Begins to hand on to `inside` who comes to these sockets. Called once.
  core::Status open(Listening listening, Inside inside);
  /// Hands nobody on any more, and lets go of all sockets. What is inside stays open.
  void close();

  /// Whoever called from there, as address_text() has it, has shown the token of this id, or needs
  /// none (empty); `machine`: that machine's own, which it was given for the token. Thread-safe.
  void mark_known(const std::string& address, const std::string& token_id = {},
                  const std::string& machine = {});

  /// Whoever called from there has shown no token that is one. Thread-safe.
  void mark_unknown(const std::string& address);

  /// Our end of the connection from there, as own_end() has it. Calls that come from there are of
  /// that one, or of one before it that was known. Thread-safe.
  std::string own_end_to(const std::string& address) const;

  /// A call from there has begun. Thread-safe.
  void note_begun(const std::string& address);
  /// A call from there is over; `broken`: broken off before it was answered. Thread-safe.
  void note_over(const std::string& address, bool broken);

  /// How many there are.
  struct Count {
    size_t waiting = 0;
    size_t inside = 0;  ///< strangers
    size_t known = 0;
  };
  Count count() const;

 private:
  using Id = StrangerQueue::Id;
  using Time = StrangerQueue::Time;
  struct Connection {
    core::Descriptor socket;  ///< inside there is another of it, which may be closed before
    std::string address;
    std::string neighbourhood;  ///< Neighbour::name; empty: it is our own user
    bool entered = false;       ///< it is inside
    bool known = false;
    std::string token_id{};               ///< by which it became known; empty: none
    std::string machine{};                ///< machine_key() of whose own that was; empty: nobody's
    std::optional<uint32_t> beginning{};  ///< of what it sends (take_beginning())
    uint32_t bound = 0;                   ///< of what is let in of a stranger
    int calls = 0;                        ///< in a row without a token that is one
    std::optional<farm::TokenBucket> broken{};  ///< calls that may be broken off
    int open_calls = 0;
  };

  void run();
  int milliseconds_to_wait() const HYADES_REQUIRES(mutex_);
  void hear(Id id, uint32_t events, Time now) HYADES_REQUIRES(mutex_);
  void accept_from(const core::Descriptor& listener, Time now) HYADES_REQUIRES(mutex_);
  void watch_listeners(bool watched) const HYADES_REQUIRES(mutex_);
  void take(core::Descriptor socket, std::string address) HYADES_REQUIRES(mutex_);
  bool may_be_mistaken(const std::string& address) const HYADES_REQUIRES(mutex_);
  void advance(Time now, std::vector<int>& entering) HYADES_REQUIRES(mutex_);
  int enter(Id id) HYADES_REQUIRES(mutex_);
  void drop(Id id) HYADES_REQUIRES(mutex_);
  bool has_place_for(const std::string& token_id, const std::string& machine) const
      HYADES_REQUIRES(mutex_);
  size_t count_of(const std::string& whose) const HYADES_REQUIRES(mutex_);
  void forget_one_of(const std::string& whose) HYADES_REQUIRES(mutex_);
  bool rests(const std::string& whose) const HYADES_REQUIRES(mutex_);
  void shut_out(Id id) HYADES_REQUIRES(mutex_);
  void look_at_strangers(Time now) HYADES_REQUIRES(mutex_);
  void wake() const;

  const Limits limits_;
  Listening listening_;
  bool beginnings_are_kept_ = false;  ///< keep_beginnings(), at all sockets
  Inside inside_;
  core::Descriptor poll_;
  core::Descriptor wake_;
  std::thread thread_;
  mutable core::Mutex mutex_;
  bool stop_ HYADES_GUARDED_BY(mutex_) = false;
  StrangerQueue strangers_ HYADES_GUARDED_BY(mutex_);
  std::unordered_map<Id, Connection> connections_ HYADES_GUARDED_BY(mutex_);
  std::unordered_map<std::string, Id> by_address_ HYADES_GUARDED_BY(mutex_);
  Time look_again_ HYADES_GUARDED_BY(mutex_);  ///< at strangers
  Time trim_again_ HYADES_GUARDED_BY(mutex_);  ///< memory
  size_t known_ HYADES_GUARDED_BY(mutex_) = 0;
  std::unordered_map<std::string, size_t> known_by_
      HYADES_GUARDED_BY(mutex_);  ///< by token, and by machine_key()
  std::unordered_map<std::string, Time> resting_
      HYADES_GUARDED_BY(mutex_);  ///< tokens and machines, until when
  std::unordered_map<std::string, Time> left_
      HYADES_GUARDED_BY(mutex_);  ///< where strangers came from that were inside, until when
  Id next_id_ HYADES_GUARDED_BY(mutex_);
  /// No file could be opened: when it is tried again.
  std::optional<Time> accept_again_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
