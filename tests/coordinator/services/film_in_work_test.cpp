// Films that are looked at while they grow.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/controller/film_copies.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

TEST(Steering, TheFilmOfAFrameCanBeSeenInMidRender) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  ScriptedWorker::Script script = world.script();
  std::atomic<int> units{0};
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit&) { return ++units <= 5; };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 5; }));
  v1::FilmRequest request;
  request.set_job(job);
  request.set_frame(1);
  const auto context = world.context();
  const auto reader = world.jobs->Film(context.get(), request);
  v1::FilmPart part;
  ASSERT_TRUE(reader->Read(&part));
  ASSERT_TRUE(part.has_header());
  std::string bytes;
  const uint64_t size = part.header().size();
  while (reader->Read(&part)) bytes += part.chunk().data();
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(bytes.size(), size);
  const auto film = core::decode_film(std::as_bytes(std::span(bytes)));
  ASSERT_TRUE(film.ok());
  EXPECT_GT(film->coverage().volume(), 0U);
}

/// A farm with a frame of which some units are there, and no more come.
class FilmInWork : public ::testing::Test {
 protected:
  void start(const std::string& document = FarmWorld::document(1)) {
    world.start();
    job = world.submit_text(document);
    ScriptedWorker::Script script = world.script();
    script.meddle = [this](ScriptedWorker&, const v1::LeasedUnit&) { return ++units_ <= 5; };
    worker_ = std::make_unique<ScriptedWorker>(world.address, script);
    ASSERT_TRUE(eventually([&] { return worker_->acknowledged() >= 5; }));
    grpc::ChannelArguments narrow;
    narrow.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 1000);
    narrow.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    unread_jobs_ = v1::Jobs::NewStub(
        grpc::CreateCustomChannel(world.address, grpc::InsecureChannelCredentials(), narrow));
    request_.set_job(job);
    request_.set_frame(1);
  }
  /// Asks for the film and reads it; how that ends.
  grpc::Status ask() {
    const auto context = world.context();
    const auto reader = world.jobs->Film(context.get(), request_);
    v1::FilmPart part;
    while (reader->Read(&part)) continue;
    return reader->Finish();
  }
  /// Asks for the film and reads only its beginning, for as long as the result is kept.
  struct Unread {
    std::unique_ptr<grpc::ClientContext> context;
    std::unique_ptr<grpc::ClientReader<v1::FilmPart>> reader;
    ~Unread() { context->TryCancel(); }
  };
  std::unique_ptr<Unread> leave_unread() {
    auto unread = std::make_unique<Unread>();
    unread->context = world.context();
    unread->reader = unread_jobs_->Film(unread->context.get(), request_);
    v1::FilmPart part;
    EXPECT_TRUE(unread->reader->Read(&part));
    return unread;
  }

  FarmWorld world;
  uint64_t job = 0;

 private:
  std::atomic<int> units_{0};
  std::unique_ptr<ScriptedWorker> worker_;
  std::unique_ptr<v1::Jobs::Stub> unread_jobs_;
  v1::FilmRequest request_;
};

// Four films may be on their way; who does not read his keeps two places of others.
TEST_F(FilmInWork, ThatIsNotReadLeavesRoomForThoseOfOthers) {
  start();
  auto first = leave_unread();
  const auto second = leave_unread();
  EXPECT_EQ(ask().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  first.reset();
  EXPECT_TRUE(eventually([&] { return ask().ok(); }));
}

TEST_F(FilmInWork, ThatIsTooLargeIsNotCopied) {
  world.options.film_memory = uint64_t{1} << 20U;
  start();
  const grpc::Status status = ask();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(status.error_message().find("a quarter of --film-memory"), std::string::npos)
      << status.error_message();
  world.stop();
  world.options.film_memory = uint64_t{64} << 20U;
  world.start();
  EXPECT_TRUE(eventually([&] { return ask().ok(); }));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Lets the process have `more` bytes of address space than it has.
void limit_memory(uint64_t more) {
  std::ifstream statm("/proc/self/statm");
  uint64_t pages = 0;
  statm >> pages;
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = pages * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) + more;
  ::setrlimit(RLIMIT_AS, &limit);
}

TEST_F(FilmInWork, ThatFindsNoMemoryEndsNoCoordinator) {
  std::string large = FarmWorld::document(1);
  const std::string size = "[80, 48]";
  start(large.replace(large.find(size), size.size(), "[1920, 1080]"));
  const auto copy = [&] {
    std::promise<grpc::Status> copied;
    const grpc::Status asked = world.controller->queries().film_alone(
        job, 1,
        [&](const grpc::Status& status, const auto&, const auto&) { copied.set_value(status); });
    return asked.ok() ? copied.get_future().get() : asked;
  };
  limit_memory(uint64_t{16} << 20U);
  const grpc::Status without = copy();
  limit_memory(uint64_t{1} << 36U);
  EXPECT_EQ(without.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(without.error_message().find("no memory"), std::string::npos);
  EXPECT_TRUE(copy().ok());
}
#endif

TEST(FilmCopies, TakeTogetherWhatTheyMay) {
  FilmCopies copies(100);
  auto one = copies.hold(60);
  EXPECT_NE(one, nullptr);
  EXPECT_EQ(copies.hold(41), nullptr) << "which takes none";
  const auto other = copies.hold(40);
  EXPECT_NE(other, nullptr);
  EXPECT_EQ(copies.hold(1), nullptr);
  one.reset();
  EXPECT_NE(copies.hold(60), nullptr);
}

}  // namespace
}  // namespace hyades::coordinator
