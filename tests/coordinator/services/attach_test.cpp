// Who may attach: versions, and two workers that go by one id.
#include <gtest/gtest.h>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

/// What becomes of a stream whose Hello says `protocol` and that many units in hand, in a call that
/// says `called`.
grpc::Status attach(const FarmWorld& world, const std::string& called, uint32_t protocol,
                    int in_hand = 0) {
  const auto stub = v1::Work::NewStub(world.channel);
  grpc::ClientContext context;
  context.AddMetadata(farm::kProtocolKey, called);
  context.set_deadline(std::chrono::system_clock::now() + 20s);
  const auto stream = stub->Attend(&context);
  v1::WorkerMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol(protocol);
  hello.set_worker_id("a-worker-of-some-version");
  hello.set_instance("a-process-of-some-version");
  hello.set_name("versions");
  hello.set_worker_class("class-a");
  hello.set_threads(1);
  for (int i = 0; i < in_hand; ++i) hello.add_in_hand()->set_job(1);
  stream->Write(message);
  v1::CoordinatorMessage reply;
  if (stream->Read(&reply) && reply.has_welcome()) stream->WritesDone();
  while (stream->Read(&reply)) {
  }
  return stream->Finish();
}

TEST(Attach, NobodyComesWithUnitsWithoutEnd) {
  FarmWorld world;
  world.start();
  const std::string ours = std::to_string(farm::kProtocol);
  const grpc::Status status = attach(world, ours, farm::kProtocol, 20'001);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.error_message().find("at most 20000"), std::string::npos)
      << status.error_message();
}

/// A token with which workers join; the farm's first one, an admin's, is made besides.
std::string joining_token(const FarmWorld& world, const std::string& name, uint32_t machines) {
  std::string text;
  StoredToken row;
  v1::CreateTokenRequest asked;
  asked.set_name(name);
  asked.set_role(v1::ROLE_WORKER);
  asked.set_machines(machines);
  EXPECT_TRUE(world.authority->create("ada", v1::ROLE_ADMIN, 0, text, row).ok());
  EXPECT_TRUE(world.authority->create(asked, text, row).ok());
  return text;
}

TEST(Attach, OlderProtocolsAreRefusedNamingBothVersions) {
  FarmWorld world;
  world.start();
  const std::string ours = std::to_string(farm::kProtocol);
  const std::string oldest = std::to_string(farm::kOldestProtocol);
  for (const grpc::Status& status :
       {attach(world, "1", farm::kProtocol), attach(world, ours, 1), attach(world, "", 1)}) {
    EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
    EXPECT_NE(status.error_message().find(oldest + " to " + ours), std::string::npos)
        << status.error_message();
  }
  EXPECT_TRUE(attach(world, ours, farm::kProtocol).ok());
  EXPECT_TRUE(attach(world, std::to_string(farm::kProtocol + 1), farm::kProtocol + 1).ok())
      << "newer callers know what we do not do";

  v1::ListJobsResponse response;
  grpc::ClientContext client;
  client.AddMetadata(farm::kProtocolKey, "1");
  EXPECT_EQ(world.jobs->List(&client, {}, &response).error_code(),
            grpc::StatusCode::FAILED_PRECONDITION)
      << "clients too";
}

TEST(Attach, TwoWorkersWithOneIdDoNotFightAndTheNewcomerIsToldToTakeAnother) {
  FarmWorld world;
  world.options.lease_time = 1s;
  world.start();
  ScriptedWorker::Script script = world.script();
  script.beat_every = 50ms;
  const ScriptedWorker first(world.address, script);
  ASSERT_TRUE(eventually([&] { return first.streams() == 1; }));
  const ScriptedWorker twin(world.address, script);
  ASSERT_TRUE(eventually([&] {
    return twin.last_status().error_code() == grpc::StatusCode::ALREADY_EXISTS;
  })) << twin.last_status().error_message();
  EXPECT_NE(twin.last_status().error_message().find("take a new one"), std::string::npos);
  EXPECT_EQ(first.streams(), 1U) << "nobody closed its stream";
  EXPECT_EQ(twin.streams(), 0U);
}

TEST(Attach, AWorkerThatHasGoneWithoutASignIsReplacedByItsSuccessor) {
  FarmWorld world;
  world.options.lease_time = 12s;  // so that silence alone ends no stream in this test
  world.start();
  ScriptedWorker::Script script = world.script();
  script.reconnect = false;
  const ScriptedWorker first(world.address, script);  // its machine has lost its power
  ASSERT_TRUE(eventually([&] { return first.streams() == 1; }));
  script.reconnect = true;
  const ScriptedWorker successor(world.address, script);
  ASSERT_TRUE(eventually([&] { return successor.streams() == 1; }));
  EXPECT_TRUE(
      eventually([&] { return first.last_status().error_code() == grpc::StatusCode::ABORTED; }));
}

TEST(Attach, NobodyTakesTheIdOfASilentWorkerOfSomebodyElse) {
  FarmWorld world;
  world.start();
  const std::string nodes = joining_token(world, "nodes", 0);
  const std::string renewed = joining_token(world, "nodes", 0);
  const std::string cloud = joining_token(world, "cloud", 0);
  ScriptedWorker::Script script = world.script();
  script.keeps_token = true;
  const auto attends = [&](const std::string& token, const std::string& instance) {
    script.token = token;
    script.instance = instance;
    const ScriptedWorker worker(world.address, script);
    grpc::Status status;
    EXPECT_TRUE(eventually([&] {
      status = worker.last_status();
      return worker.streams() == 1 || status.error_code() == grpc::StatusCode::ALREADY_EXISTS;
    })) << status.error_message();
    return worker.streams() == 1;
  };
  EXPECT_TRUE(attends(nodes, "the-first-process"));
  EXPECT_FALSE(attends(cloud, "a-thief-who-knows-the-id"));
  EXPECT_TRUE(attends(renewed, "the-second-process")) << "another token of the same name";
  EXPECT_TRUE(attends(cloud, "the-second-process")) << "a process whose token was changed";
  EXPECT_FALSE(attends(nodes, "the-third-process"));
}

TEST(Attach, ATokenJoinsAsManyMachinesAsItMay) {
  FarmWorld world;
  world.options.forget_time = 1s;
  world.start();
  ScriptedWorker::Script script = world.script();
  script.keeps_token = true;
  script.token = joining_token(world, "nodes", 1);
  ScriptedWorker::Script more = script;
  more.id = "one-more-worker-of-it";
  auto first = std::make_unique<ScriptedWorker>(world.address, script);
  ASSERT_TRUE(eventually([&] { return first->streams() == 1; }));
  const ScriptedWorker second(world.address, more);
  ASSERT_TRUE(eventually([&] {
    return second.last_status().error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
  })) << second.last_status().error_message();
  EXPECT_NE(second.last_status().error_message().find("--machines"), std::string::npos);
  script.token = first->welcome().machine_token();
  ASSERT_FALSE(script.token.empty());
  first = std::make_unique<ScriptedWorker>(world.address, script);
  EXPECT_TRUE(eventually([&] { return first->streams() == 1; })) << "it is the one";
  EXPECT_EQ(second.streams(), 0U);
  first.reset();
  EXPECT_TRUE(eventually([&] { return second.streams() == 1; })) << "once it is forgotten";
}

}  // namespace
}  // namespace hyades::coordinator
