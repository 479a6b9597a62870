// Answers that come in pieces, and readers that do not read them.
#include <gtest/gtest.h>

#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "coordinator/meters/meters.h"
#include "coordinator/web/connection.h"
#include "farm/thread_pool.h"

namespace hyades::coordinator {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// More bytes than the kernel keeps for one who does not read.
class LongSource final : public BodySource {
 public:
  static constexpr uint64_t kBytes = uint64_t{8} << 20U;
  std::optional<std::string> next() override {
    const uint64_t count = std::min<uint64_t>(kPieceBytes, kBytes - at_);
    at_ += count;
    return std::string(count, 'x');
  }
  std::optional<uint64_t> size() const override { return kBytes; }
  uint64_t bytes_kept() const override { return 1000; }

 private:
  uint64_t at_ = 0;
};

/// Something that happens from time to time.
class NewsSource final : public BodySource {
 public:
  std::optional<std::string> next() override { return has_news() && ++told_ > 0 ? "news" : ""; }
  std::optional<uint64_t> size() const override { return std::nullopt; }
  bool goes_on() const override { return true; }
  bool has_news() const override { return Clock::now() >= begun_ + told_ * kEvery; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kEvery{1};
  const Clock::time_point begun_ = Clock::now();
  int told_ = 0;
};

/// A server of which every answer is long.
class LongAnswers {
 public:
  /// At most `most` bytes of answers are in memory. `make`: makes what is sent.
  explicit LongAnswers(
      uint64_t most, std::function<std::shared_ptr<BodySource>()> make =
                         [] { return std::make_shared<LongSource>(); })
      : budget(most, most),
        world{
            [](WebRequest& request, const OwnEnd&) {
              request.caller.name = "ada";
              return ConnectionWorld::Admitted{};
            },
            [](const Caller&, const std::function<void(const grpc::Status&)>&) {
              return std::unique_ptr<Visit>();
            },
            [](const Caller&, grpc::Status&) { return std::unique_ptr<OwnerConnections::Entry>(); },
            [make = std::move(make)](const WebRequest&, const Answer& answer) {
              WebReply reply;
              reply.source = make();
              answer(reply);
            },
            files,
            std::make_shared<IoHandle>(network),
            meters,
            budget,
            budget,
            ConnectionCount(100, 100, 8)},
        acceptor(network, tcp::endpoint(asio::ip::address_v4::loopback(), 0)) {
    accept();
    thread = std::thread([this] { network.run(); });
  }
  ~LongAnswers() {
    world.io->close();
    network.stop();
    thread.join();
  }
  LongAnswers(const LongAnswers&) = delete;
  LongAnswers& operator=(const LongAnswers&) = delete;

  /// Before anybody asks.
  void set_patience(std::chrono::milliseconds patience) { world.send_patience = patience; }
  unsigned short port() { return acceptor.local_endpoint().port(); }

 private:
  void accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error) return;
      make_connection(std::move(socket), {}, {}, nullptr, world)->begin();
      accept();
    });
  }

  farm::ByteBudget budget;
  asio::io_context network;
  Meters meters;
  farm::ThreadPool files{1, 100};
  ConnectionWorld world;
  tcp::acceptor acceptor;
  std::thread thread;
};

/// One who asks, and reads nothing of himself.
class Asker {
 public:
  explicit Asker(unsigned short port) {
    socket_.open(tcp::v4());
    socket_.set_option(asio::socket_base::receive_buffer_size(4096));
    socket_.connect({asio::ip::address_v4::loopback(), port});
    asio::write(socket_, asio::buffer(std::string("GET / HTTP/1.1\r\nHost: a\r\n\r\n")));
  }
  /// Reads until `count` bytes have come, or nothing for so long; how many have.
  uint64_t read(uint64_t count, std::chrono::milliseconds patience) {
    timeval wait{patience.count() / 1000, patience.count() % 1000 * 1000};
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    std::string some(size_t{1} << 16U, '\0');
    uint64_t sum = 0;
    while (sum < count) {
      const ssize_t got = ::recv(socket_.native_handle(), some.data(), some.size(), 0);
      if (got <= 0) break;
      sum += static_cast<uint64_t>(got);
    }
    return sum;
  }

  /// Whether `words` have come before nothing came for so long; `text`: what has.
  bool read_until(const std::string& words, std::string& text, std::chrono::milliseconds patience) {
    timeval wait{patience.count() / 1000, patience.count() % 1000 * 1000};
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    std::string some(1000, '\0');
    while (text.find(words) == std::string::npos) {
      const ssize_t got = ::recv(socket_.native_handle(), some.data(), some.size(), 0);
      if (got <= 0) return false;
      text.append(some, 0, static_cast<size_t>(got));
    }
    return true;
  }

 private:
  asio::io_context none_;
  tcp::socket socket_{none_};
};

TEST(UnreadPieces, WaitUntilOthersAreRead) {
  LongAnswers server(2 * (BodySource::kPieceBytes + 1000) + 1000);
  std::optional<Asker> first(server.port());
  ASSERT_GT(first->read(1, std::chrono::seconds(20)), 0U);
  Asker second(server.port());
  ASSERT_GT(second.read(1, std::chrono::seconds(20)), 0U);
  Asker third(server.port());
  EXPECT_LT(third.read(LongSource::kBytes, std::chrono::milliseconds(700)), 1000U)
      << "a header, and no room for a piece";
  first.reset();
  EXPECT_GE(third.read(LongSource::kBytes, std::chrono::seconds(20)), LongSource::kBytes);
  EXPECT_GE(second.read(LongSource::kBytes - 1, std::chrono::seconds(20)),
            LongSource::kBytes - 100'000);
}

TEST(UnreadPieces, WhoWaitsForNewsHasAllTheTime) {
  LongAnswers server(uint64_t{1} << 20U, [] { return std::make_shared<NewsSource>(); });
  server.set_patience(std::chrono::milliseconds(700));
  Asker reader(server.port());
  ASSERT_GT(reader.read(1, std::chrono::seconds(20)), 0U);
  std::string text;
  EXPECT_TRUE(reader.read_until("newsnewsnews", text, std::chrono::seconds(20))) << text;
}

TEST(UnreadPieces, WhatSourcesKeepCountsToo) {
  LongAnswers server(BodySource::kPieceBytes + 2500);
  Asker first(server.port());
  ASSERT_GT(first.read(1, std::chrono::seconds(20)), 0U);
  // This one keeps its thousand bytes and waits for a piece; there is no room for another thousand.
  Asker second(server.port());
  EXPECT_LT(second.read(LongSource::kBytes, std::chrono::milliseconds(300)), 1000U);
  Asker third(server.port());
  EXPECT_LT(third.read(LongSource::kBytes, std::chrono::milliseconds(300)), 1000U);
  EXPECT_GE(first.read(LongSource::kBytes - 1, std::chrono::seconds(20)),
            LongSource::kBytes - 100'000);
}

}  // namespace
}  // namespace hyades::coordinator
