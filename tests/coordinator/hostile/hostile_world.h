#pragma once

#include <gtest/gtest.h>

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <string>

#include "tests/coordinator/hostile/coordinator_process.h"
#include "tests/coordinator/hostile/raw_http2.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {

/// MiB. What nobody's bytes explain: program, gRPC's threads and arenas, the honest job.
inline constexpr uint64_t kUsual = 150;

/// A coordinator in a process of its own, somebody honest who uses it, and whoever the test lets
/// loose on it.
class Hostile : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(process.address().empty()) << "the coordinator does not start";
    world.connect(process.address());
  }

  /// A job goes in, is rendered by an honest worker, and its pictures are right.
  void expect_served(int frames = 2) {
    const uint64_t job = world.submit(frames);
    {
      ScriptedWorker::Script script = world.script(++workers_);
      script.threads = 4;
      const ScriptedWorker worker(world.address, script);
      EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
    }
    for (int frame = 1; frame <= frames; ++frame) world.expect_truth(job, frame);
  }

  /// It lives, has never had more memory than `mib` MiB, and ends in order.
  void expect_sane(uint64_t mib) {
    EXPECT_TRUE(process.alive());
    const uint64_t peak = process.peak_mib();
    std::printf("peak: %lu MiB\n", peak);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LE(peak, mib);
#endif
    EXPECT_EQ(process.end(), 0);
  }

  /// Calls any method with any bytes; what came of it. Takes one message of the answer, and no
  /// more than `timeout`.
  grpc::Status call(const std::string& method, const std::string& bytes,
                    std::chrono::milliseconds timeout = 300ms) const {
    grpc::GenericStub stub(world.channel);
    grpc::CompletionQueue queue;
    const auto context = world.context(timeout);
    const auto stream = stub.PrepareCall(context.get(), method, &queue);
    const auto done = [&](bool& ok) {
      void* tag = nullptr;
      return queue.Next(&tag, &ok);
    };
    bool ok = false;
    stream->StartCall(nullptr);
    done(ok);
    const grpc::Slice slice(bytes);
    if (ok) {
      stream->Write(grpc::ByteBuffer(&slice, 1), grpc::WriteOptions().set_last_message(), nullptr);
      done(ok);
    }
    grpc::ByteBuffer answer;
    stream->Read(&answer, nullptr);
    done(ok);
    if (ok) context->TryCancel();
    grpc::Status status;
    stream->Finish(&status, nullptr);
    done(ok);
    queue.Shutdown();
    while (done(ok)) {
    }
    return status;
  }

  test::CoordinatorProcess process;
  FarmWorld world;

 private:
  int workers_ = 0;
};

}  // namespace hyades::coordinator
