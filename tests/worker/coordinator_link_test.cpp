// The stream to a coordinator that says more than anybody hears.

#include "worker/coordinator_link.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include "farm/channels.h"
#include "hyades/v1/work.grpc.pb.h"
#include "tests/support/relay.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;

/// Says the same until nobody listens any more, or so often.
class Talker : public v1::Work::Service {
 public:
  Talker(v1::CoordinatorMessage message, size_t times)
      : message_(std::move(message)), times_(times) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
    channel_ = grpc::CreateChannel(address(), grpc::InsecureChannelCredentials());
  }
  ~Talker() override { server_->Shutdown(std::chrono::system_clock::now()); }
  Talker(const Talker&) = delete;
  Talker& operator=(const Talker&) = delete;

  grpc::Status Attend(
      grpc::ServerContext* context,
      grpc::ServerReaderWriter<v1::CoordinatorMessage, v1::WorkerMessage>* stream) override {
    for (size_t i = 0; i < times_ && stream->Write(message_); ++i) ++written;
    while (!context->IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return grpc::Status::OK;
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

  std::atomic<size_t> written{0};

 private:
  const v1::CoordinatorMessage message_;
  const size_t times_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

class Listener : public CoordinatorLink::Listener {
 public:
  void stream_says(v1::CoordinatorMessage /*message*/) override {
    const std::lock_guard lock(mutex_);
    ++said_;
    changed_.notify_all();
  }
  void stream_ended(StreamEnd how, const std::string& reason,
                    std::chrono::milliseconds /*retry_after*/) override {
    const std::lock_guard lock(mutex_);
    how_ = how;
    end_ = reason;
    changed_.notify_all();
  }
  size_t said() const {
    const std::lock_guard lock(mutex_);
    return said_;
  }
  bool wait_for(size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, seconds(60), [&] { return said_ >= count; });
  }
  std::string wait_for_end() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(60), [this] { return !end_.empty(); });
    return end_;
  }
  /// After wait_for_end().
  StreamEnd how() const {
    const std::lock_guard lock(mutex_);
    return how_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  size_t said_ = 0;
  StreamEnd how_ = StreamEnd::broken;
  std::string end_;
};

v1::CoordinatorMessage brief_of(size_t bytes) {
  v1::CoordinatorMessage message;
  message.mutable_job()->mutable_spec()->set_document(std::string(bytes, 'd'));
  return message;
}

TEST(CoordinatorLink, IsReadOnlyAsItIsHeard) {
  for (const size_t bytes : {size_t{10}, size_t{300'000}}) {
    const size_t most = bytes < 1000 ? CoordinatorLink::kMostUnheard
                                     : CoordinatorLink::kMostUnheardBytes / bytes + 1;
    const Talker coordinator(brief_of(bytes), 1000);
    Listener listener;
    CoordinatorLink link("", listener);
    link.open(coordinator.channel());
    ASSERT_TRUE(listener.wait_for(most));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(listener.said(), most);
    link.heard();
    ASSERT_TRUE(listener.wait_for(most + 1));
    for (size_t i = 1; i < 1000; ++i) {
      ASSERT_TRUE(listener.wait_for(i));
      link.heard();
    }
    EXPECT_TRUE(listener.wait_for(1000)) << "nothing is lost";
    // And it can be ended while it is not read.
  }
}

TEST(CoordinatorLink, IsBrokenOffThoughNobodyReads) {
  const Talker coordinator(brief_of(10), 1'000'000);
  Listener listener;
  CoordinatorLink link("", listener);
  link.open(coordinator.channel());
  ASSERT_TRUE(listener.wait_for(CoordinatorLink::kMostUnheard));
  link.break_off("enough of this");
  EXPECT_EQ(listener.wait_for_end(), "enough of this");
}

TEST(CoordinatorLink, EndsWhileItIsNotRead) {
  const Talker coordinator(brief_of(10), 1'000'000);
  Listener listener;
  {
    CoordinatorLink link("", listener);
    link.open(coordinator.channel());
    ASSERT_TRUE(listener.wait_for(CoordinatorLink::kMostUnheard));
  }
  EXPECT_FALSE(listener.wait_for_end().empty());
}

/// Two bytes each, which would take seventy once they are parsed.
TEST(CoordinatorLink, AMessageOfTooManyPartsEndsTheStream) {
  v1::CoordinatorMessage message;
  for (int i = 0; i < 300'000; ++i) message.mutable_job()->mutable_spec()->add_files();
  const Talker coordinator(message, 1);
  Listener listener;
  CoordinatorLink link("", listener);
  link.open(coordinator.channel());
  EXPECT_NE(listener.wait_for_end().find("too many parts"), std::string::npos);
  EXPECT_EQ(listener.said(), 0U);
}

TEST(CoordinatorLink, TellsWhetherAnybodyAnswered) {
  const test::Relay silent;
  farm::Peer peer;
  peer.address = "127.0.0.1:1," + silent.address();
  const auto nobody = farm::Channels::open(peer);
  ASSERT_TRUE(nobody.ok());
  for (size_t i = 0; i < 2; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    Listener listener;
    CoordinatorLink link("", listener);
    const farm::Channels::Way way = (*nobody)->current();
    link.open(way.channel);
    EXPECT_FALSE(listener.wait_for_end().empty());
    EXPECT_EQ(listener.how(), StreamEnd::unanswered) << way.address;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(8)) << way.address;
    (*nobody)->failed(way);
  }
  const Talker coordinator(brief_of(10), 1);
  Listener listener;
  CoordinatorLink link("", listener);
  link.open(coordinator.channel());
  ASSERT_TRUE(listener.wait_for(1));
  link.break_off("enough of this");
  listener.wait_for_end();
  EXPECT_EQ(listener.how(), StreamEnd::broken);
}

/// The kernel of its machine goes on to take what is sent.
TEST(CoordinatorLink, NoticesSoonThatACoordinatorIsFrozenWhereThereAreOthers) {
  const Talker coordinator(brief_of(10), 1);
  test::Relay relay(coordinator.address());
  farm::Peer peer;
  peer.address = relay.address() + ",127.0.0.1:1";
  const auto channels = farm::Channels::open(peer);
  ASSERT_TRUE(channels.ok());
  Listener listener;
  CoordinatorLink link("", listener);
  link.open((*channels)->current().channel);
  ASSERT_TRUE(listener.wait_for(1));
  link.heard();
  relay.freeze();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(listener.wait_for_end().empty());
  EXPECT_EQ(listener.how(), StreamEnd::unanswered);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(8)) << "4 s, on a busy machine";
}

}  // namespace
}  // namespace hyades::worker
