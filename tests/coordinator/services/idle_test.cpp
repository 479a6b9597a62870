// Connections that nobody uses.
#include <gtest/gtest.h>

#include <grpcpp/create_channel.h>

#include "farm/channels.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

TEST(Idle, AConnectionWithoutCallsIsEndedAndOneWithAStreamStays) {
  FarmWorld world;
  world.serving.idle = 300ms;
  world.start();
  const uint64_t job = world.submit(1);
  // Else both would be calls of one connection.
  grpc::ChannelArguments alone;
  alone.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto other =
      grpc::CreateCustomChannel(world.address, grpc::InsecureChannelCredentials(), alone);
  const auto context = world.context();
  v1::WatchRequest watch;
  watch.set_job(job);
  const auto jobs = v1::Jobs::NewStub(other);
  const auto reader = jobs->Watch(context.get(), watch);
  v1::WatchEvent event;
  ASSERT_TRUE(reader->Read(&event));
  // Its calls are over.
  EXPECT_TRUE(eventually([&] { return world.channel->GetState(false) != GRPC_CHANNEL_READY; }));
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(other->GetState(false), GRPC_CHANNEL_READY);
  v1::JobRequest request;
  request.set_job(job);
  v1::JobResponse response;
  EXPECT_TRUE(world.jobs->Cancel(world.context().get(), request, &response).ok())
      << "whoever was cut off comes again with the next call";
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok()) << "a stream goes on to its end";
}

TEST(Idle, PingsOfWhoHasOtherAddressesAreNoOffence) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  farm::Peer peer;
  peer.address = world.address + ",127.0.0.1:1";
  const auto channels = farm::Channels::open(peer);
  ASSERT_TRUE(channels.ok());
  const auto context = world.context();
  v1::WatchRequest watch;
  watch.set_job(job);
  const auto jobs = v1::Jobs::NewStub((*channels)->current().channel);
  const auto reader = jobs->Watch(context.get(), watch);
  v1::WatchEvent event;
  ASSERT_TRUE(reader->Read(&event));
  std::this_thread::sleep_for(10s);  // five of them, with nothing said in between
  v1::JobRequest request;
  request.set_job(job);
  v1::JobResponse response;
  EXPECT_TRUE(world.jobs->Cancel(world.context().get(), request, &response).ok());
  while (reader->Read(&event)) {
  }
  const grpc::Status status = reader->Finish();
  EXPECT_TRUE(status.ok()) << status.error_message();
}

}  // namespace
}  // namespace hyades::coordinator
