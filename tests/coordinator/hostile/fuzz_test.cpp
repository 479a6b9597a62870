// Every method with bytes that nobody meant.
#include <thread>
#include <vector>

#include "tests/coordinator/hostile/hostile_world.h"
#include "tests/coordinator/hostile/random_message.h"

namespace hyades::coordinator {
namespace {

constexpr int kThreads = 4;
constexpr int kRounds = 40;

std::vector<const google::protobuf::MethodDescriptor*> all_methods() {
  std::vector<const google::protobuf::MethodDescriptor*> methods;
  for (const auto* file :
       {v1::SubmitRequest::descriptor()->file(), v1::WorkerMessage::descriptor()->file(),
        v1::FindMissingRequest::descriptor()->file(), v1::InfoRequest::descriptor()->file()}) {
    for (int s = 0; s < file->service_count(); ++s) {
      for (int m = 0; m < file->service(s)->method_count(); ++m) {
        methods.push_back(file->service(s)->method(m));
      }
    }
  }
  return methods;
}

TEST_F(Hostile, FuzzedRequests) {
  world.submit(1);  // a job for those who mean 1
  std::vector<std::thread> threads;
  std::atomic<int> refused{0};
  std::atomic<int> calls{0};
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      test::Random random(static_cast<uint32_t>(t));
      for (int round = 0; round < kRounds; ++round) {
        for (const auto* method : all_methods()) {
          std::string bytes =
              random() % 4 == 0
                  ? test::random_bytes(random, 2000)
                  : test::random_message(random, *method->input_type())->SerializeAsString();
          if (random() % 2 == 0) bytes = test::mutated(random, std::move(bytes));
          const std::string path = "/" + method->service()->full_name() + "/" + method->name();
          const grpc::Status status = call(path, bytes, 100ms);
          EXPECT_NE(status.error_code(), grpc::StatusCode::UNIMPLEMENTED) << path;
          refused += status.error_code() == grpc::StatusCode::INVALID_ARGUMENT;
          ++calls;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::printf("%d calls, %d of them invalid\n", calls.load(), refused.load());
  EXPECT_GT(refused, calls / 10) << "hardly anything was looked at";
  expect_served();
  expect_sane(kUsual);
}

/// A worker that says hello as it should, and then anything.
void babble(const FarmWorld& world, uint32_t seed, int messages) {
  test::Random random(seed);
  const auto stub = v1::Work::NewStub(world.channel);
  const auto context = world.context(10s);
  const auto stream = stub->Attend(context.get());
  v1::WorkerMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol(farm::kProtocol);
  hello.set_worker_id("babbling-worker-" + std::to_string(1000 + seed));
  hello.set_instance("process-" + std::to_string(10'000'000 + seed));
  hello.set_name("babbler");
  hello.set_worker_class("class-a");
  hello.set_threads(4);
  hello.set_want(4);
  stream->Write(message);
  v1::CoordinatorMessage said;
  std::vector<v1::LeasedUnit> units;
  if (!stream->Read(&said) || !said.has_welcome()) return;
  for (int i = 0; i < messages; ++i) {
    const auto any = test::random_message(random, *v1::WorkerMessage::descriptor());
    message.CopyFrom(*any);
    if (i % 2 == 0) {  // a film of a job that is there, with everything else wrong
      v1::UnitResult& result = *message.mutable_result();
      result.set_job(1 + random() % 3);
      result.mutable_unit()->set_frame(1);
      result.mutable_unit()->mutable_tile()->set_x1(32);
      result.mutable_unit()->mutable_tile()->set_y1(32);
      result.mutable_unit()->set_batches(1);
      result.set_digest(test::random_bytes(random, 0) + std::string(32, 'd'));
      core::FilmLayout layout = core::make_film_layout({});
      const auto film =
          core::encode_film(fake_film({1, {0, 0, 32, 32}, {0, 1}}, FarmWorld::kSamples, layout));
      result.set_film(test::mutated(
          random, std::string(reinterpret_cast<const char*>(film.data()), film.size())));
    }
    if (message.has_leaving() || !stream->Write(message)) continue;
  }
  stream->WritesDone();
  while (stream->Read(&said)) {
  }
  (void)stream->Finish();
}

TEST_F(Hostile, WorkersThatSendGarbage) {
  world.submit(1);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (uint32_t i = 0; i < 10; ++i) babble(world, static_cast<uint32_t>(10 * t) + i, 100);
    });
  }
  expect_served(3);
  for (std::thread& thread : threads) thread.join();
  expect_served();
  expect_sane(kUsual);
}

}  // namespace
}  // namespace hyades::coordinator
