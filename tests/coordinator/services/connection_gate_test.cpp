#include "coordinator/services/connection_gate.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <deque>
#include <filesystem>
#include <functional>
#include <iterator>
#include <thread>
#include <utility>

#include "coordinator/services/receive_bound.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

size_t open_files() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}

/// One that connects, and says nothing.
class PlainCaller {
 public:
  /// `own_port`: 0 for one that is free; others may have it too, to other addresses.
  explicit PlainCaller(uint16_t port, const char* from = "127.0.0.1", uint16_t own_port = 0,
                       const char* to_host = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in own = at(from, own_port);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&own), sizeof own), 0);
    const sockaddr_in to = at(to_host, port);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    socklen_t size = sizeof own;
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&own), &size);
    own_port_ = ntohs(own.sin_port);
    address_ = std::string(from) + ":" + std::to_string(own_port_);
  }

  const std::string& address() const { return address_; }
  bool ended(std::chrono::milliseconds within) const {
    pollfd ready{socket_.get(), POLLIN, 0};
    char byte = 0;
    return ::poll(&ready, 1, static_cast<int>(within.count())) == 1 &&
           ::recv(socket_.get(), &byte, 1, 0) <= 0;
  }
  uint16_t own_port() const { return own_port_; }
  void hang_up() { socket_.close(); }
  /// Without a farewell: the port is free at once.
  void reset() {
    const linger at_once{1, 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    socket_.close();
  }
  /// Leaves so many bytes to the kernel.
  void talk(size_t bytes) const {
    const std::string text(bytes, 'x');
    EXPECT_EQ(::send(socket_.get(), text.data(), bytes, MSG_NOSIGNAL), static_cast<ssize_t>(bytes));
  }

 private:
  static sockaddr_in at(const char* host, uint16_t port) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    ::inet_pton(AF_INET, host, &place.sin_addr);
    return place;
  }

  core::Descriptor socket_;
  std::string address_;
  uint16_t own_port_ = 0;
};

/// A gate with a room behind it in which nobody does anything.
class ConnectionGateTest : public testing::Test {
 protected:
  ConnectionGateTest() {
    limits.strangers = {.inside = 2,
                        .inside_of_one = 1,
                        .waiting = 3,
                        .patience = 1min,
                        .patience_when_full = 1min};
  }
  ~ConnectionGateTest() override {
    if (gate) gate->close();
  }

  void open(const std::vector<std::string>& addresses = {"127.0.0.1:0"}) {
    auto listening = listen_at(addresses);
    ASSERT_TRUE(listening.ok()) << (listening ? "" : listening.error().message);
    port = listening->port;
    gate.emplace(limits);
    const core::Status open = gate->open(std::move(*listening), [this](int socket) {
      const core::MutexLock lock(mutex);
      room.emplace_back(socket);
    });
    ASSERT_TRUE(open.ok()) << (open ? "" : open.error().message);
  }
  static bool soon(const std::function<bool()>& what) {
    for (int i = 0; i < 4000 && !what(); ++i) std::this_thread::sleep_for(5ms);
    return what();
  }
  bool holds(size_t waiting, size_t inside, size_t known) const {
    return soon([&] {
      const ConnectionGate::Count now = gate->count();
      return now.waiting == waiting && now.inside == inside && now.known == known;
    });
  }
  size_t came_in() {
    const core::MutexLock lock(mutex);
    return room.size();
  }

  ConnectionGate::Limits limits;
  uint16_t port = 0;
  core::Mutex mutex;
  std::deque<core::Descriptor> room HYADES_GUARDED_BY(mutex);
  std::optional<ConnectionGate> gate;
};

TEST_F(ConnectionGateTest, WhoSaysNothingIsShutOutAndWhoIsKnownStays) {
  limits.strangers.patience = 300ms;
  open();
  const PlainCaller silent(port, "127.0.0.2");
  const PlainCaller known(port);
  ASSERT_TRUE(holds(0, 2, 0));
  gate->mark_known(known.address());
  EXPECT_TRUE(silent.ended(20s));
  EXPECT_FALSE(known.ended(1s));
  EXPECT_TRUE(holds(0, 0, 1));
}

TEST_F(ConnectionGateTest, TheKnownTakeNoPlaceOfStrangers) {
  open();
  std::deque<PlainCaller> workers;
  for (size_t i = 1; i <= 20; ++i) {
    workers.emplace_back(port);
    ASSERT_TRUE(soon([&] { return came_in() == i; })) << i;
    gate->mark_known(workers.back().address());
  }
  EXPECT_TRUE(holds(0, 0, 20));
}

TEST_F(ConnectionGateTest, OthersComeInWhileACrowdWaits) {
  open();
  std::deque<PlainCaller> crowd;
  for (int i = 0; i < 30; ++i) crowd.emplace_back(port, "127.0.0.2");
  ASSERT_TRUE(holds(3, 1, 0)) << "26 were turned away";
  const PlainCaller honest(port);
  EXPECT_TRUE(holds(3, 2, 0));
  gate->mark_known(honest.address());
  EXPECT_TRUE(holds(3, 1, 1));
  // Those who give up are not let in later.
  for (PlainCaller& one : crowd) one.hang_up();
  EXPECT_TRUE(soon([&] { return gate->count().waiting == 0; }));
}

TEST_F(ConnectionGateTest, TheKnownAreBounded) {
  limits.known = 2;
  open();
  std::deque<PlainCaller> workers;
  for (size_t i = 1; i <= 3; ++i) {
    workers.emplace_back(port);
    ASSERT_TRUE(soon([&] { return came_in() == i; })) << i;
    gate->mark_known(workers.back().address());
  }
  EXPECT_TRUE(workers.back().ended(20s));
  EXPECT_TRUE(holds(0, 0, 2));
}

TEST_F(ConnectionGateTest, OneTokenDoesNotShutAllOthersOut) {
  limits.known = 8;
  open();
  std::deque<PlainCaller> callers;
  const auto connect = [&](const std::string& token_id) {
    callers.emplace_back(port);
    EXPECT_TRUE(soon([&] { return came_in() == callers.size(); }));
    gate->mark_known(callers.back().address(), token_id);
  };
  for (int i = 0; i < 6; ++i) connect("greedy");
  ASSERT_TRUE(holds(0, 0, 4)) << "as many as were free then";
  EXPECT_TRUE(callers.back().ended(20s));
  for (int i = 0; i < 3; ++i) connect("second");
  EXPECT_TRUE(holds(0, 0, 6));
  connect("third");
  EXPECT_TRUE(holds(0, 0, 7));
  {
    const core::MutexLock lock(mutex);
    ::shutdown(room.front().get(), SHUT_RDWR);
  }
  ASSERT_TRUE(holds(0, 0, 6));
  connect("");
  EXPECT_TRUE(holds(0, 0, 7)) << "where no token is asked for all are one";
}

TEST_F(ConnectionGateTest, OneMachineDoesNotShutOthersOutThatJoinedAsItDid) {
  limits.known = 16;
  limits.open_calls = 10;
  limits.broken_rest = 1h;
  open();
  std::deque<PlainCaller> callers;
  const auto connect = [&](const std::string& machine) -> PlainCaller& {
    callers.emplace_back(port);
    EXPECT_TRUE(soon([&] { return came_in() == callers.size(); }));
    gate->mark_known(callers.back().address(), "joining", machine);
    return callers.back();
  };
  for (int i = 0; i < 6; ++i) connect("greedy");
  ASSERT_TRUE(holds(0, 0, 4)) << "a quarter of what is free";
  const PlainCaller& honest = connect("honest");
  EXPECT_TRUE(holds(0, 0, 5));
  for (int i = 0; i < 11; ++i) gate->note_begun(callers.front().address());
  EXPECT_TRUE(callers.front().ended(20s));
  EXPECT_TRUE(connect("greedy").ended(20s)) << "it rests";
  connect("another");
  EXPECT_TRUE(holds(0, 0, 5)) << "who joined by the same token does not";
  EXPECT_FALSE(honest.ended(100ms));
}

TEST_F(ConnectionGateTest, WhoTalksBeforeHeIsKnownIsCutOff) {
  open();
  const PlainCaller brief(port);
  const PlainCaller talker(port, "127.0.0.2");
  ASSERT_TRUE(holds(0, 2, 0));
  brief.talk(15'000);
  talker.talk(100'000);
  EXPECT_TRUE(talker.ended(20s));
  EXPECT_FALSE(brief.ended(0ms));
  EXPECT_FALSE(PlainCaller(port, "127.0.0.2").ended(100ms)) << "others of that address come in";
}

TEST_F(ConnectionGateTest, WhoCallsAndCallsWithoutATokenIsCutOff) {
  open();
  const PlainCaller stranger(port, "127.0.0.2");
  const PlainCaller known(port);
  ASSERT_TRUE(holds(0, 2, 0));
  gate->mark_known(known.address());
  for (int i = 1; i < limits.stranger_calls; ++i) gate->mark_unknown(stranger.address());
  EXPECT_FALSE(stranger.ended(100ms));
  gate->mark_unknown(stranger.address());
  EXPECT_TRUE(stranger.ended(20s));
  for (int i = 0; i < 100; ++i) {
    gate->mark_known(known.address());
    gate->mark_unknown(known.address());
  }
  EXPECT_FALSE(known.ended(100ms)) << "mistakes of one who is known";
  for (int i = 1; i < limits.stranger_calls; ++i) gate->mark_unknown(known.address());
  EXPECT_TRUE(known.ended(20s)) << "whose token is good no more";
}

TEST_F(ConnectionGateTest, WhatWasHeldBackComesInWhenItsSenderIsKnown) {
  limits.stranger_pace = 1h;
  open();
  const PlainCaller caller(port);
  ASSERT_TRUE(soon([&] { return came_in() == 1; }));
  constexpr size_t kMuch = 100'000;
  caller.talk(kMuch);
  const core::MutexLock lock(mutex);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(bytes_received(room.front()), limits.stranger_bytes_at_once);
  std::string text(kMuch, '\0');
  size_t received = 0;
  gate->mark_known(caller.address());
  EXPECT_TRUE(soon([&] {
    const ssize_t count = ::recv(room.front().get(), text.data(), text.size(), 0);
    received += count > 0 ? static_cast<size_t>(count) : 0;
    return received == kMuch;
  })) << received;
}

TEST_F(ConnectionGateTest, WhoeverHasTheSocketMayEndIt) {
  open();
  const PlainCaller caller(port);
  ASSERT_TRUE(soon([&] { return came_in() == 1; }));
  gate->mark_known(caller.address());
  {
    const core::MutexLock lock(mutex);
    ::shutdown(room.front().get(), SHUT_RDWR);
    room.clear();
  }
  EXPECT_TRUE(holds(0, 0, 0));
  EXPECT_TRUE(caller.ended(20s));
}

TEST_F(ConnectionGateTest, NothingIsLeftBehind) {
  const size_t before = open_files();
  open();
  {
    std::deque<PlainCaller> crowd;
    for (int i = 0; i < 3; ++i) crowd.emplace_back(port);
    ASSERT_TRUE(holds(2, 1, 0));
    gate->close();
    // Which of them is inside depends on how many come at once.
    EXPECT_TRUE(soon([&] {
      const auto over = [](const PlainCaller& caller) { return caller.ended(0ms); };
      return std::count_if(crowd.begin(), crowd.end(), over) == 2;
    })) << "two waited";
    const core::MutexLock lock(mutex);
    room.clear();
  }
  gate.reset();
  EXPECT_EQ(open_files(), before);
}

TEST_F(ConnectionGateTest, WithoutFilesItWaitsForThem) {
  open();
  const PlainCaller before(port);
  ASSERT_TRUE(soon([&] { return came_in() == 1; }));
  gate->mark_known(before.address());
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
  std::optional<PlainCaller> late;
  {
    // All files below the limit are open, but for the one with which somebody connects.
    std::deque<core::Descriptor> all;
    const core::Descriptor lowest(::dup(0));
    rlimit none = usual;
    none.rlim_cur = static_cast<rlim_t>(lowest.get()) + 64;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    for (int file = ::dup(0); file >= 0; file = ::dup(0)) all.emplace_back(file);
    all.pop_back();
    late.emplace(port);
    const std::clock_t begun = std::clock();
    std::this_thread::sleep_for(1s);
    EXPECT_LT(std::clock() - begun, CLOCKS_PER_SEC / 2) << "it tries again and again";
    EXPECT_EQ(came_in(), 1U);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual), 0);
  }
  EXPECT_TRUE(soon([&] { return came_in() == 2; }));
}

TEST_F(ConnectionGateTest, AnAddressIsTheSameAtASocketForBothFamilies) {
  open({"[::]:0"});
  const PlainCaller caller(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(caller.address());
  EXPECT_TRUE(holds(0, 0, 1));
}

TEST_F(ConnectionGateTest, WhoseTokenIsRevokedGoesAfterAFewCalls) {
  limits.stranger_calls = 3;
  open();
  PlainCaller caller(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(caller.address(), "ada");
  ASSERT_TRUE(holds(0, 0, 1));
  gate->mark_unknown(caller.address());
  gate->mark_unknown(caller.address());
  gate->mark_known(caller.address(), "ada");  // behind a proxy others may call by it
  gate->mark_unknown(caller.address());
  gate->mark_unknown(caller.address());
  EXPECT_FALSE(caller.ended(100ms));
  gate->mark_unknown(caller.address());
  EXPECT_TRUE(caller.ended(20s));
  EXPECT_TRUE(holds(0, 0, 0));
}

TEST_F(ConnectionGateTest, TellsAtWhichAddressSomebodyCameIn) {
  open({"127.0.0.1:0", "127.0.0.2:0"});
  PlainCaller one(port);
  const PlainCaller two(port, "127.0.0.9", 0, "127.0.0.2");
  ASSERT_TRUE(holds(0, 2, 0));
  EXPECT_EQ(gate->own_end_to(one.address()), "127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(gate->own_end_to(two.address()), "127.0.0.2:" + std::to_string(port));
  EXPECT_EQ(gate->own_end_to("127.0.0.1:1"), "");
  one.reset();
  EXPECT_EQ(gate->own_end_to(one.address()), "");
}

/// gRPC tells whose a call is by the address alone.
TEST_F(ConnectionGateTest, NobodyComesFromWhereAStrangerIsOrHasJustBeen) {
  limits.address_rest = 1h;
  open({"127.0.0.1:0", "127.0.0.2:0"});
  PlainCaller stranger(port);
  ASSERT_TRUE(holds(0, 1, 0));
  const PlainCaller meanwhile(port, "127.0.0.1", stranger.own_port(), "127.0.0.2");
  EXPECT_TRUE(meanwhile.ended(20s));
  stranger.reset();
  const PlainCaller after(port, "127.0.0.1", stranger.own_port());
  EXPECT_TRUE(after.ended(20s));
  EXPECT_EQ(gate->own_end_to(after.address()), "");
}

TEST_F(ConnectionGateTest, WhoIsKnownKeepsHisAddressAndMayComeFromThereAgain) {
  limits.address_rest = 1h;
  open({"127.0.0.1:0", "127.0.0.2:0"});
  PlainCaller known(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(known.address());
  const PlainCaller thief(port, "127.0.0.1", known.own_port(), "127.0.0.2");
  EXPECT_TRUE(thief.ended(20s));
  EXPECT_EQ(gate->own_end_to(known.address()), "127.0.0.1:" + std::to_string(port));
  known.reset();
  const PlainCaller again(port, "127.0.0.1", known.own_port());
  EXPECT_TRUE(holds(0, 1, 0));
  EXPECT_EQ(gate->own_end_to(again.address()), "127.0.0.1:" + std::to_string(port));
}

TEST_F(ConnectionGateTest, WhoHasFarTooManyCallsInWorkGoes) {
  limits.open_calls = 10;
  open();
  PlainCaller caller(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(caller.address(), "ada");
  for (int i = 0; i < 100; ++i) {
    gate->note_begun(caller.address());
    gate->note_over(caller.address(), false);
  }
  for (int i = 0; i < 10; ++i) gate->note_begun(caller.address());
  EXPECT_FALSE(caller.ended(100ms));
  gate->note_begun(caller.address());
  EXPECT_TRUE(caller.ended(20s));
}

TEST_F(ConnectionGateTest, WhoBreaksCallAfterCallOffGoesAndRests) {
  limits.broken_calls = 10;
  limits.broken_calls_per_second = 0;
  limits.broken_rest = 1h;
  open();
  PlainCaller caller(port);
  ASSERT_TRUE(holds(0, 1, 0));
  for (int i = 0; i < 20; ++i) gate->note_over(caller.address(), true);
  EXPECT_FALSE(caller.ended(100ms)) << "a stranger's bytes are bounded instead";
  gate->mark_known(caller.address(), "ada");
  for (int i = 0; i < 10; ++i) gate->note_over(caller.address(), true);
  EXPECT_FALSE(caller.ended(100ms));
  gate->note_over(caller.address(), true);
  EXPECT_TRUE(caller.ended(20s));
  PlainCaller again(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(again.address(), "ada");
  EXPECT_TRUE(again.ended(20s)) << "by that token nobody comes in for a while";
  PlainCaller other(port);
  ASSERT_TRUE(holds(0, 1, 0));
  gate->mark_known(other.address(), "bob");
  EXPECT_TRUE(holds(0, 0, 1));
}

}  // namespace
}  // namespace hyades::coordinator
