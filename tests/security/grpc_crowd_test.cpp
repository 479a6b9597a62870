// Strangers who come to gRPC in crowds, and begin what they do not end.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <grpcpp/create_channel.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/controller/all_pages.h"
#include "hyades/v1/admin.grpc.pb.h"
#include "tests/coordinator/hostile/coordinator_process.h"
#include "tests/coordinator/hostile/raw_http2.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr int kCallsOfEach = 100;
/// MiB that a crowd may cost.
constexpr uint64_t kMostOfCrowd = 64;

int crowd_size() {
  const char* wanted = std::getenv("HYADES_CROWD");
  return wanted != nullptr ? std::atoi(wanted) : 600;
}

/// Connections with many calls each that show no token and are not ended, of two neighbourhoods
/// that are not the farm's.
class Crowd {
 public:
  Crowd(const std::string& address, int size) {
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    for (int i = 0; i < size; ++i) {
      test::RawHttp2& one =
          peers_.emplace_back(address, true, i % 2 == 0 ? "127.0.0.2" : "127.0.0.3");
      for (int k = 0; k < kCallsOfEach; ++k) one.call("/hyades.v1.Jobs/Submit");
    }
  }

 private:
  std::deque<test::RawHttp2> peers_;
};

/// How long each of several calls over `channel` takes until it is answered; the median.
std::chrono::duration<double> usual_time(
    const FarmWorld& world, int calls, const std::function<std::shared_ptr<grpc::Channel>()>& to) {
  std::vector<std::chrono::duration<double>> times;
  for (int i = 0; i < calls; ++i) {
    const auto begun = std::chrono::steady_clock::now();
    const auto stub = v1::Farm::NewStub(to());
    v1::InfoResponse info;
    const grpc::Status status = stub->Info(world.context().get(), {}, &info);
    EXPECT_TRUE(status.ok()) << status.error_message();
    times.emplace_back(std::chrono::steady_clock::now() - begun);
    std::this_thread::sleep_for(100ms);
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

class GrpcCrowd : public testing::Test {
 protected:
  GrpcCrowd() {
    std::ofstream(token_file) << kToken << "\n";
    world.token = kToken;
    world.how.token_file = token_file;
  }

  FarmWorld world;
  const std::string token_file = world.folder.file("token");
};

TEST_F(GrpcCrowd, CostsLittleMemoryAndNobodysTime) {
  test::CoordinatorProcess process({"--token-file", token_file});
  ASSERT_FALSE(process.address().empty()) << "the coordinator does not start";
  world.connect(process.address());
  const auto known = [&] { return world.channel; };
  const auto fresh = [&]() -> std::shared_ptr<grpc::Channel> {
    grpc::ChannelArguments alone;
    alone.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(world.address, grpc::InsecureChannelCredentials(), alone);
  };
  usual_time(world, 5, known);
  const uint64_t before = process.memory_mib();
  auto crowd = std::make_unique<Crowd>(process.address(), crowd_size());
  EXPECT_LT(usual_time(world, 21, known).count(), 1) << "who is known is not kept waiting";
  // Whose place is taken by a crowd comes in when the patience with that ends.
  EXPECT_LT(usual_time(world, 5, fresh).count(), 10);
  const uint64_t peak = process.peak_mib();
  std::printf("before: %lu MiB, peak: %lu MiB\n", before, peak);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LE(peak, before + kMostOfCrowd);
  crowd.reset();
  EXPECT_TRUE(eventually([&] { return process.memory_mib() <= before + kMostOfCrowd / 2; }))
      << "it is not given back";
#endif
  EXPECT_EQ(process.end(), 0);
}

TEST_F(GrpcCrowd, WhoIsUnknownForTooLongIsShutOut) {
  world.serving.gate.strangers.patience = 500ms;
  world.start();
  v1::InfoResponse info;
  ASSERT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
  test::RawHttp2 silent(world.address, false);
  test::RawHttp2 idle(world.address);
  test::RawHttp2 tokenless(world.address);
  tokenless.call("/hyades.v1.Farm/Info");
  test::RawHttp2 guessing(world.address);
  guessing.call("/hyades.v1.Farm/Info", {{"authorization", "Bearer none of this farm's"}});
  for (test::RawHttp2* peer : {&silent, &idle, &tokenless, &guessing}) {
    EXPECT_TRUE(peer->closed(20'000));
  }
  EXPECT_EQ(world.channel->GetState(false), GRPC_CHANNEL_READY) << "who has shown a token stays";
  EXPECT_EQ(world.server->connections().known, 1U);
}

TEST_F(GrpcCrowd, NobodysMessageIsReadBeforeHisToken) {
  world.start();
  for (const char* method : {"/hyades.v1.Jobs/Submit", "/hyades.v1.Jobs/Watch"}) {
    test::RawHttp2 peer(world.address);
    const uint32_t call = peer.call(method);
    EXPECT_TRUE(peer.ended(call, 20'000)) << method << ": not a byte of it was sent";
    const uint32_t large = peer.call(method);
    const std::string body = test::RawHttp2::head(200U << 20U) + std::string(32U << 20U, 'x');
    EXPECT_LT(peer.send(large, body), body.size() / 2) << method;
    EXPECT_TRUE(peer.ended(large, 20'000)) << method;
  }
}

TEST_F(GrpcCrowd, AMessageThatDoesNotComeEndsTheCall) {
  world.serving.request_patience = 300ms;
  world.start();
  for (const char* method : {"/hyades.v1.Jobs/Submit", "/hyades.v1.Jobs/Watch"}) {
    test::RawHttp2 peer(world.address);
    const uint32_t call = peer.call(method, {{"authorization", std::string("Bearer ") + kToken}});
    peer.send(call, test::RawHttp2::head(1000) + "half");
    EXPECT_TRUE(peer.ended(call, 20'000)) << method;
  }
}

TEST_F(GrpcCrowd, HeadersThatDoNotEndAndCallsThatAreBrokenOffCostLittle) {
  test::CoordinatorProcess process({"--token-file", token_file});
  ASSERT_FALSE(process.address().empty()) << "the coordinator does not start";
  const uint64_t before = process.memory_mib();
  constexpr uint64_t kMuch = 256U << 20U;
  for (int i = 0; i < 3; ++i) {
    test::RawHttp2 endless(process.address(), true, "127.0.0.2");
    endless.greeted(1000);
    EXPECT_LT(endless.endless_headers(kMuch), kMuch / 2);
    test::RawHttp2 broken(process.address(), true, "127.0.0.3");
    broken.greeted(1000);
    EXPECT_LT(broken.broken_calls("/hyades.v1.Farm/Info", kMuch), kMuch / 2);
  }
  const uint64_t peak = process.peak_mib();
  std::printf("before: %lu MiB, peak: %lu MiB\n", before, peak);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // What comes in costs ten times as much.
  EXPECT_LE(peak, before + kMostOfCrowd);
#endif
  EXPECT_EQ(process.end(), 0);
}

TEST_F(GrpcCrowd, WhoHasATokenBreaksNoCallsOffWithoutEnd) {
  test::CoordinatorProcess process({"--token-file", token_file});
  ASSERT_FALSE(process.address().empty()) << "the coordinator does not start";
  world.connect(process.address());
  usual_time(world, 1, [&] { return world.channel; });
  const uint64_t before = process.memory_mib();
  constexpr uint64_t kMuch = 64U << 20U;
  test::RawHttp2 known(process.address());
  const std::vector<std::pair<std::string, std::string>> token = {
      {"authorization", std::string("Bearer ") + kToken}, {"hyades-protocol", "1"}};
  ASSERT_TRUE(known.greeted(20'000));
  ASSERT_TRUE(known.ended(known.call("/hyades.v1.Farm/Info", token), 500) || known.connected());
  EXPECT_LT(known.broken_calls("/hyades.v1.Farm/Info", kMuch, token), kMuch / 2);
  const uint64_t peak = process.peak_mib();
  std::printf("before: %lu MiB, peak: %lu MiB\n", before, peak);
  EXPECT_LT(usual_time(world, 3, [&] { return world.channel; }).count(), 5) << "who is in stays";
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LE(peak, before + 4 * kMostOfCrowd);
#endif
  EXPECT_EQ(process.end(), 0);
}

/// Asks for so many files, none of which is there: an answer of 40 bytes for each.
v1::FindMissingRequest find_missing(uint32_t files) {
  v1::FindMissingRequest request;
  for (uint32_t i = 0; i < files; ++i) {
    v1::JobFile& file = *request.add_files();
    file.set_sha256(fmt::format("{:032}", i));
    file.set_size(5);
  }
  return request;
}

/// As it goes over the wire.
std::string framed(const google::protobuf::MessageLite& message) {
  const std::string bytes = message.SerializeAsString();
  return test::RawHttp2::head(static_cast<uint32_t>(bytes.size())) + bytes;
}

/// Sends that over a connection that reads no more of the answer than its window.
uint32_t ask_without_reading(test::RawHttp2& peer, const v1::FindMissingRequest& request) {
  EXPECT_TRUE(peer.greeted(20'000));
  const uint32_t call = peer.call("/hyades.v1.Assets/FindMissing",
                                  {{"authorization", std::string("Bearer ") + kToken}});
  const std::string message = framed(request);
  EXPECT_EQ(peer.send(call, message), message.size());
  peer.finish(call);
  return call;
}

TEST_F(GrpcCrowd, AnAnswerThatIsNotReadEndsTheCall) {
  world.serving.request_patience = 300ms;
  world.start();
  test::RawHttp2 peer(world.address);
  const uint32_t call = ask_without_reading(peer, find_missing(10'000));
  EXPECT_TRUE(peer.ended(call, 20'000)) << "it may read 64 KiB of 400";
}

TEST_F(GrpcCrowd, AnswersThatAreNotReadTakeNobodyElsesRoom) {
  world.serving.waiting_of_one = uint64_t{1} << 20U;
  world.start();
  v1::CreateTokenRequest wanted;
  wanted.set_name("bob");
  wanted.set_role(v1::ROLE_SUBMITTER);
  v1::CreateTokenResponse bob;
  const auto admin = v1::Admin::NewStub(world.channel);
  ASSERT_TRUE(admin->CreateToken(world.context().get(), wanted, &bob).ok());
  const v1::FindMissingRequest request = find_missing(10'000);
  const auto asks_as = [&](const std::string& token) {
    world.token = token;
    v1::FindMissingResponse missing;
    return world.assets->FindMissing(world.context().get(), request, &missing);
  };
  ASSERT_TRUE(asks_as(kToken).ok());
  std::deque<test::RawHttp2> peers;
  // One large request is looked at at a time: not all of these get as far as an answer.
  EXPECT_TRUE(eventually([&] {
    ask_without_reading(peers.emplace_back(world.address), request);
    const grpc::Status refused = asks_as(kToken);
    return refused.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED &&
           refused.error_message().find("not read") != std::string::npos;
  }));
  EXPECT_TRUE(eventually([&] { return asks_as(bob.secret()).ok(); }));
}

TEST_F(GrpcCrowd, WhatWorkersDoNotReadCountsToo) {
  world.serving.waiting_of_one = 800'000;
  world.start();
  const v1::FindMissingRequest request = find_missing(10'000);  // an answer of 340 kB
  const auto refused = [&] {
    v1::FindMissingResponse response;
    const grpc::Status status =
        world.assets->FindMissing(world.context().get(), request, &response);
    return status.error_message().find("not read") != std::string::npos;
  };
  test::RawHttp2 worker(world.address);
  EXPECT_TRUE(worker.greeted(20'000));
  const uint32_t call =
      worker.call("/hyades.v1.Work/Attend",
                  {{"authorization", std::string("Bearer ") + kToken}, {"hyades-protocol", "2"}});
  v1::WorkerMessage hello;
  hello.mutable_hello()->set_protocol(farm::kProtocol);
  hello.mutable_hello()->set_worker_id("a-worker-that-does-not-read");
  hello.mutable_hello()->set_instance("only-one-process");
  hello.mutable_hello()->set_name("deaf");
  hello.mutable_hello()->set_worker_class("class-a");
  hello.mutable_hello()->set_threads(1);
  worker.send(call, framed(hello));
  // What is sent before it is known may wait in the kernel, and then comes all at once.
  EXPECT_TRUE(eventually([&] { return !all_workers(*world.controller).empty(); }));
  v1::WorkerMessage word;
  word.mutable_result()->set_job(7);  // of no job: it is answered
  std::string words;
  for (int i = 0; i < 200; ++i) words += framed(word);
  bool told = false;
  // Fewer than are the most, however short they are.
  for (int i = 0; i < 80 && !told; ++i) {
    worker.send(call, words);
    // While an answer of the other's is on its way, the worker itself may be the one without room.
    told = refused() || worker.ended(call, 0);
  }
  EXPECT_TRUE(told);
  while (worker.send(call, words) == words.size()) {
  }
  EXPECT_TRUE(worker.ended(call, 20'000)) << "it is cut off";
  EXPECT_TRUE(eventually([&] { return !refused(); })) << "what waited is not counted any more";
}

TEST_F(GrpcCrowd, StreamsThatAreNotReadCountToo) {
  world.serving.waiting_of_one = uint64_t{120} << 10U;
  world.start();
  const std::string file(uint64_t{2} << 20U, 'x');
  ASSERT_TRUE(world.upload(file).ok());
  v1::DownloadRequest request;
  request.set_sha256(farm::to_wire(core::sha256(file)));
  const auto download = [&](test::RawHttp2& peer) {
    EXPECT_TRUE(peer.greeted(20'000));
    const uint32_t call =
        peer.call("/hyades.v1.Assets/Download",
                  {{"authorization", std::string("Bearer ") + kToken}, {"hyades-protocol", "2"}});
    peer.send(call, framed(request));
    peer.finish(call);
    return call;
  };
  test::RawHttp2 first(world.address);
  const uint32_t waits = download(first);
  EXPECT_FALSE(first.ended(waits, 500)) << "a piece is larger than what it may send unread";
  test::RawHttp2 second(world.address);
  EXPECT_TRUE(second.ended(download(second), 20'000));
  EXPECT_FALSE(first.ended(waits, 0));
}

TEST_F(GrpcCrowd, RowsThatAreReadAheadCountToo) {
  world.serving.waiting_of_one = uint64_t{256} << 10U;
  world.start();
  std::string path;
  for (int i = 0; i < 8; ++i) path += std::string(240, static_cast<char>('a' + i)) + "/";
  const uint64_t job = world.submit_text(
      "hyades: 1\nframes: {range: 1-60}\nfilm: {size: [4, 4]}\nsampling: {samples: 1}\n"
      "environment: {color: 1}\noutputs: [{file: '" +
      path + "####.png'}]\n");
  {
    const ScriptedWorker worker(world.address, world.script());
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  }
  v1::OutputsRequest request;
  request.set_job(job);
  std::deque<test::RawHttp2> peers;
  bool refused = false;
  while (!refused && peers.size() < 12) {
    test::RawHttp2& peer = peers.emplace_back(world.address);
    EXPECT_TRUE(peer.greeted(20'000));
    const uint32_t call =
        peer.call("/hyades.v1.Jobs/Outputs",
                  {{"authorization", std::string("Bearer ") + kToken}, {"hyades-protocol", "2"}});
    peer.send(call, framed(request));
    peer.finish(call);
    refused = peer.ended(call, 500);
  }
  EXPECT_TRUE(refused) << "of 120 kB of rows each has read 64 KiB, and others wait in memory";
  EXPECT_LE(peers.size(), 8U);
}

}  // namespace
}  // namespace hyades::coordinator
