// A coordinator that means ill, against a worker's real processes.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <grpcpp/grpcpp.h>

#include "farm/wire.h"
#include "hyades/v1/work.grpc.pb.h"
#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;
using HostileStream = grpc::ServerReaderWriter<v1::CoordinatorMessage, v1::WorkerMessage>;

v1::CoordinatorMessage welcome_of(const std::string& name) {
  v1::CoordinatorMessage message;
  message.mutable_welcome()->set_protocol(farm::kProtocol);
  message.mutable_welcome()->set_heartbeat_ms(1000);
  message.mutable_welcome()->set_lease_ms(60'000);
  message.mutable_welcome()->set_name(name);
  return message;
}

/// Welcomes whoever comes, and then does on their stream what it was told to.
class HostileCoordinator : public v1::Work::Service {
 public:
  explicit HostileCoordinator(std::function<void(HostileStream&)> deed) : deed_(std::move(deed)) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }
  ~HostileCoordinator() override { server_->Shutdown(std::chrono::system_clock::now()); }
  HostileCoordinator(const HostileCoordinator&) = delete;
  HostileCoordinator& operator=(const HostileCoordinator&) = delete;

  grpc::Status Attend(grpc::ServerContext* context, HostileStream* stream) override {
    v1::WorkerMessage hello;
    if (!stream->Read(&hello)) return grpc::Status::OK;
    stream->Write(welcome_of("a worker"));
    deed_(*stream);
    ++streams;
    for (int i = 0; i < 4000 && !context->IsCancelled(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (context->IsCancelled()) ++cut_off;
    return grpc::Status::OK;
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  std::atomic<int> streams{0};  ///< on which it has done its deed
  std::atomic<int> cut_off{0};  ///< of these, by the worker

 private:
  const std::function<void(HostileStream&)> deed_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

/// The most memory that the process has had [MiB].
uint64_t most_memory_mib(pid_t pid) {
  const std::string status = read_file("/proc/" + std::to_string(pid) + "/status");
  const size_t at = status.find("VmHWM:");
  return at == std::string::npos ? 0 : std::stoull(status.substr(at + 6)) / 1024;
}

bool wait_for(const std::atomic<int>& number, int least) {
  const auto end = std::chrono::steady_clock::now() + seconds(120);
  while (number < least && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return number >= least;
}

TEST(HostileCoordinator, OneThatTellsOfJobsWithoutEndGetsLittleMemory) {
  const test::TempFolder folder;
  HostileCoordinator coordinator([](HostileStream& stream) {
    v1::CoordinatorMessage message;
    message.mutable_job()->mutable_spec()->set_name(std::string(15'000'000, 'n'));
    for (uint64_t job = 1; job <= 30; ++job) {
      message.mutable_job()->set_job(job);
      if (!stream.Write(message)) return;
    }
  });
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(wait_for(coordinator.cut_off, 2)) << worker.log();
  EXPECT_LT(most_memory_mib(worker.pid()), 400U) << "of 450 MB on each stream";
  EXPECT_NE(worker.log().find("told of more jobs than all that a farm has"), std::string::npos)
      << worker.log();
}

TEST(HostileCoordinator, OneThatWelcomesAllTheTimeFillsNoLog) {
  const test::TempFolder folder;
  HostileCoordinator coordinator([](HostileStream& stream) {
    const v1::CoordinatorMessage message = welcome_of(std::string(1'000'000, 'L'));
    for (int i = 0; i < 20; ++i) {
      if (!stream.Write(message)) return;
    }
  });
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(wait_for(coordinator.cut_off, 2)) << worker.log().substr(0, 5000);
  EXPECT_LT(worker.log().size(), 20'000U);
  EXPECT_NE(worker.log().find("welcomed this worker twice"), std::string::npos);
}

TEST(HostileCoordinator, OneThatLeasesWithoutEndIsCutOff) {
  const test::TempFolder folder;
  HostileCoordinator coordinator([](HostileStream& stream) {
    v1::CoordinatorMessage message;
    message.mutable_job()->set_job(1);
    stream.Write(message);
    for (int i = 0; i < 10'000; ++i) {
      v1::Unit& unit = *message.mutable_lease()->add_units();
      unit.set_frame(i);
      unit.mutable_tile()->set_x1(16);
      unit.mutable_tile()->set_y1(16);
      unit.set_batches(1);
    }
    message.mutable_lease()->set_job(1);
    while (stream.Write(message)) {
    }
  });
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(wait_for(coordinator.cut_off, 2)) << worker.log();
  EXPECT_NE(worker.log().find("leases units that nobody asked for"), std::string::npos);
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(seconds(10)), 0) << "and nothing holds it up";
}

}  // namespace
}  // namespace hyades::worker
