// What clients and workers may send, and what they are told beyond it.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "coordinator/services/worker_bytes.h"
#include "farm/part_count.h"
#include "tests/coordinator/services/farm_world.h"
#include "tests/support/resident_bytes.h"

namespace hyades::coordinator {
namespace {

using grpc::StatusCode;

class Limits : public testing::Test {
 protected:
  void SetUp() override { world.start(); }

  grpc::Status submit(const std::function<void(v1::SubmitRequest&)>& change) const {
    v1::SubmitRequest request = FarmWorld::request(FarmWorld::document(1));
    change(request);
    v1::SubmitResponse response;
    return world.jobs->Submit(world.context().get(), request, &response);
  }

  void expect_refused(const grpc::Status& status, StatusCode code, const std::string& words) const {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_NE(status.error_message().find(words), std::string::npos) << status.error_message();
  }

  FarmWorld world;
};

TEST_F(Limits, OfSubmit) {
  ASSERT_TRUE(world.upload(FarmWorld::document(1)).ok());
  const auto invalid = StatusCode::INVALID_ARGUMENT;
  expect_refused(submit([](auto& r) { r.set_owner(std::string(201, 'o')); }), invalid, "owner");
  expect_refused(submit([](auto& r) { r.set_idempotency_key("short"); }), invalid, "16 to 64");
  expect_refused(submit([](auto& r) { r.set_priority(1'000'001); }), invalid, "priority");
  expect_refused(submit([](auto& r) { r.mutable_spec()->set_name(std::string(201, 'n')); }),
                 invalid, "name");
  expect_refused(submit([](auto& r) { r.mutable_spec()->set_samples(1U << 25U); }), invalid,
                 "samples");
  expect_refused(submit([](auto& r) {
                   for (int i = 0; i < 10'001; ++i) {
                     auto* range = r.mutable_spec()->add_frames();
                     range->set_first(1);
                     range->set_last(1);
                   }
                 }),
                 invalid, "10001 ranges");
  expect_refused(
      submit([](auto& r) { r.mutable_spec()->mutable_files(0)->set_path(std::string(4097, 'p')); }),
      invalid, "4096");
  expect_refused(submit([](auto& r) {
                   const v1::JobFile file = r.spec().files(0);
                   for (int i = 0; i < 100'000; ++i) *r.mutable_spec()->add_files() = file;
                 }),
                 invalid, "100001 files");
  expect_refused(
      submit([](auto& r) { r.mutable_spec()->set_document(std::string(17 << 20, 'd')); }), invalid,
      "16777216");
  EXPECT_TRUE(submit([](auto&) {}).ok()) << "the same without any of that";
}

// gRPC looks at how long a message is when it has unpacked it.
TEST_F(Limits, PackedMessagesAreNotUnpacked) {
  const std::string text = FarmWorld::document(1);
  ASSERT_TRUE(world.upload(text).ok());
  v1::SubmitRequest request = FarmWorld::request(text);
  request.mutable_spec()->set_name(std::string(150, 'a'));  // which is shorter when it is packed
  v1::SubmitResponse response;
  for (const bool packed : {true, false}) {
    const auto context = world.context();
    if (packed) context->set_compression_algorithm(GRPC_COMPRESS_GZIP);
    const grpc::Status status = world.jobs->Submit(context.get(), request, &response);
    EXPECT_EQ(status.ok(), !packed) << status.error_message();
  }
}

TEST_F(Limits, OfOtherRequestsAreMuchLower) {
  const uint64_t job = world.submit(1);
  {
    v1::WorkerRequest request;
    request.set_worker(std::string(70'000, 'w'));
    v1::WorkerResponse response;
    expect_refused(world.farm_->DrainWorker(world.context().get(), request, &response),
                   StatusCode::INVALID_ARGUMENT, "65536");
  }
  {
    v1::LogsRequest request;
    request.set_job(job);
    for (int i = 0; i <= 10'000; ++i) request.add_frames(1);
    const auto context = world.context();
    const auto reader = world.jobs->Logs(context.get(), request);
    v1::LogLine line;
    EXPECT_FALSE(reader->Read(&line));
    expect_refused(reader->Finish(), StatusCode::INVALID_ARGUMENT, "10000 frames");
  }
  {
    v1::OutputsRequest request;
    request.set_job(job);
    for (int i = 0; i <= 100; ++i) request.add_frames()->set_last(1);
    const auto context = world.context();
    const auto reader = world.jobs->Outputs(context.get(), request);
    v1::OutputFile file;
    EXPECT_FALSE(reader->Read(&file));
    expect_refused(reader->Finish(), StatusCode::INVALID_ARGUMENT, "100 ranges of more than one");
  }
  {
    const auto context = world.context();
    v1::UploadResponse response;
    const auto writer = world.assets->Upload(context.get(), &response);
    v1::UploadPart part;
    part.set_sha256(std::string(32, 'x'));
    part.set_size(uint64_t{1} << 30U);
    part.mutable_chunk()->set_data(std::string((1 << 20) + 2000, 'c'));
    writer->Write(part);
    writer->WritesDone();
    expect_refused(writer->Finish(), StatusCode::INVALID_ARGUMENT, "are the most here");
  }
}

TEST_F(Limits, OfAnswersWhichComeInParts) {
  constexpr int kFrames = 20'000;
  const uint64_t job = world.submit(kFrames);
  for (const bool over : {false, true}) {
    if (over) {
      v1::JobRequest request;
      request.set_job(job);
      v1::JobResponse response;
      ASSERT_TRUE(world.jobs->Cancel(world.context().get(), request, &response).ok());
    }
    v1::GetJobRequest request;
    request.set_job(job);
    v1::GetJobResponse part;
    int frames = 0;
    do {
      ASSERT_TRUE(world.jobs->Get(world.context().get(), request, &part).ok());
      EXPECT_LT(part.ByteSizeLong(), 70'000U);
      for (const v1::Frame& frame : part.frames()) {
        EXPECT_EQ(frame.frame(), ++frames);
        request.set_after(frame.frame());
      }
    } while (part.more());
    EXPECT_EQ(frames, over ? 0 : kFrames);

    v1::WatchRequest watch;
    watch.set_job(job);
    const auto context = world.context();
    const auto reader = world.jobs->Watch(context.get(), watch);
    v1::WatchEvent event;
    frames = 0;
    int events = 0;
    do {
      ASSERT_TRUE(reader->Read(&event));
      EXPECT_LT(event.ByteSizeLong(), 70'000U);
      EXPECT_EQ(event.job().id(), job);
      for (const v1::Frame& frame : event.changed()) EXPECT_EQ(frame.frame(), ++frames);
      ++events;
    } while (event.more());
    EXPECT_EQ(frames, over ? 0 : kFrames);
    EXPECT_TRUE(over || events > 1) << "all of it fits into one: ask for more frames";
  }
}

/// Hears nothing.
class DeafLink final : public WorkerLink {
 public:
  void send(grpc::ByteBuffer) override {}
  void close(const grpc::Status&) override {}
};

TEST_F(Limits, OfAnAnswerThatTellsOfAllWorkers) {
  constexpr uint64_t kWorkers = 1500;
  const auto link = std::make_shared<DeafLink>();
  for (uint64_t i = 0; i < kWorkers; ++i) {
    v1::Hello hello;
    hello.set_protocol(farm::kProtocol);
    hello.set_worker_id("a-worker-among-many-" + std::to_string(i));
    hello.set_instance("a-process-among-many");
    hello.set_name(std::string(200, 'n'));
    hello.set_worker_class("class-a");
    hello.set_threads(1);
    for (int tag = 0; tag < 32; ++tag) {
      hello.add_tags(std::to_string(100 + tag) + std::string(37, 't'));
    }
    WorkerId worker{};
    ASSERT_TRUE(world.controller->workers().attach(hello, link, worker).ok());
  }
  v1::WorkersRequest request;
  uint64_t seen = 0;
  int pages = 0;
  do {
    v1::WorkersResponse page;
    ASSERT_TRUE(world.farm_->Workers(world.context().get(), request, &page).ok());
    EXPECT_LT(page.ByteSizeLong(), 1'100'000U);
    for (const v1::Worker& worker : page.workers()) EXPECT_EQ(worker.id(), ++seen);
    request.set_after(page.next_after());
    ++pages;
  } while (request.after() != 0);
  EXPECT_EQ(seen, kWorkers);
  EXPECT_GT(pages, 1);
}

TEST_F(Limits, OfAllOpenJobsTogether) {
  const uint64_t one = world.submit(1'000'000);
  const auto of_bob = [](v1::SubmitRequest& asked) { asked.set_owner("bob"); };
  world.submit(999'999, of_bob);
  world.submit(1, of_bob);
  v1::SubmitResponse response;
  v1::SubmitRequest request = FarmWorld::request(FarmWorld::document(1));
  request.set_owner("eve");
  const grpc::Status status = world.jobs->Submit(world.context().get(), request, &response);
  expect_refused(status, StatusCode::RESOURCE_EXHAUSTED, "open jobs");
  EXPECT_EQ(farm::detail_of(status).retry_after_ms(), 60'000U);
  v1::JobRequest cancelled;
  cancelled.set_job(one);
  v1::JobResponse ignored;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), cancelled, &ignored).ok());
  EXPECT_TRUE(world.jobs->Submit(world.context().get(), request, &response).ok());
}

TEST_F(Limits, OfTheMemoryThatAFilmTakes) {
  std::string huge = FarmWorld::document(1);
  huge.replace(huge.find("[80, 48]"), 8, "[16384, 16384]");
  ASSERT_TRUE(world.upload(huge).ok());
  v1::SubmitResponse response;
  const auto submitted = [&](const std::string& text) {
    return world.jobs->Submit(world.context().get(), FarmWorld::request(text), &response);
  };
  world.stop();
  world.options.film_memory = uint64_t{1} << 20U;
  world.start();
  expect_refused(submitted(huge), StatusCode::INVALID_ARGUMENT, "16384 x 16384");
  expect_refused(submitted(huge), StatusCode::INVALID_ARGUMENT, "--film-memory");
  const uint64_t job = world.submit(3);

  // A coordinator that has less recovers all but this job, instead of ending again and again.
  world.stop();
  world.options.film_memory = 1000;
  world.start();
  const v1::Job now = world.get(job).job();
  EXPECT_EQ(now.state(), v1::JOB_STATE_FAILED);
  EXPECT_NE(now.reason().find("80 x 48"), std::string::npos) << now.reason();
}

// A frame of so many samples knows of each batch who has it: 256 KiB for each tile at which
// somebody works. Frames that are open, and at which nobody does, take none of it.
TEST_F(Limits, OfTheMemoryThatSamplesTake) {
  world.stop();
  world.options.film_memory = uint64_t{256} << 20U;
  world.start();
  std::string many = FarmWorld::document(256);
  many.replace(many.find("samples: 40"), 11, "samples: 16777216");
  const auto sized = [&](const char* size) {
    std::string text = many;
    text.replace(text.find("[80, 48]"), 8, size);
    return text;
  };
  v1::SubmitResponse response;
  const auto submitted = [&](const std::string& text) {
    v1::SubmitRequest request = FarmWorld::request(text);
    request.set_frame_order(v1::FRAME_ORDER_PROGRESSIVE);
    return world.jobs->Submit(world.context().get(), request, &response);
  };
  ASSERT_TRUE(world.upload(sized("[1024, 1024]")).ok());
  expect_refused(submitted(sized("[1024, 1024]")), StatusCode::INVALID_ARGUMENT,
                 "16777216 samples take");
  const uint64_t before = test::resident_bytes();
  for (int i = 0; i < 4; ++i) {
    const std::string text = sized(i % 2 == 0 ? "[400, 400]" : "[384, 384]");
    ASSERT_TRUE(world.upload(text).ok());
    const grpc::Status status = submitted(text);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  EXPECT_LT(test::resident_bytes(), before + (uint64_t{32} << 20U));
}

TEST_F(Limits, OfFramesThatAreNamedAgainAndAgain) {
  ASSERT_TRUE(world.upload(FarmWorld::document(1000)).ok());
  v1::SubmitRequest request = FarmWorld::request(FarmWorld::document(1000));
  for (int i = 0; i < 5000; ++i) {
    auto* range = request.mutable_spec()->add_frames();
    range->set_first(1);
    range->set_last(1000);
  }
  v1::SubmitResponse response;
  expect_refused(world.jobs->Submit(world.context().get(), request, &response),
                 StatusCode::INVALID_ARGUMENT, "more than a million frames");
}

TEST_F(Limits, OfTextsWhichHaveToBeReadable) {
  std::string text = FarmWorld::document(1);
  text.replace(text.find("balls"), 5, "b\xFFlls");
  ASSERT_TRUE(world.upload(text).ok());
  v1::SubmitResponse response;
  const grpc::Status status =
      world.jobs->Submit(world.context().get(), FarmWorld::request(text), &response);
  EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << status.error_message();
  v1::ListJobsResponse list;
  EXPECT_TRUE(world.jobs->List(world.context().get(), {}, &list).ok()) << "nobody could read it";
}

TEST_F(Limits, OfWorkersHoldForAllButFilms) {
  const auto stub = v1::Work::NewStub(world.channel);
  grpc::ClientContext context;
  farm::prepare(context, "", std::chrono::milliseconds(0));
  const auto stream = stub->Attend(&context);
  v1::WorkerMessage message;
  message.mutable_hello()->set_name(std::string((1 << 20) + 100, 'n'));
  stream->Write(message);
  v1::CoordinatorMessage reply;
  EXPECT_FALSE(stream->Read(&reply));
  expect_refused(stream->Finish(), StatusCode::INVALID_ARGUMENT, "besides a film");
}

TEST_F(Limits, AWorkerThatDoesNotReadIsCutOff) {
  const auto stub = v1::Work::NewStub(world.channel);
  grpc::ClientContext context;
  farm::prepare(context, "", std::chrono::seconds(60));
  const auto stream = stub->Attend(&context);
  v1::WorkerMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol(farm::kProtocol);
  hello.set_worker_id("a-worker-that-does-not-read");
  hello.set_instance("only-one-process");
  hello.set_name("deaf");
  hello.set_worker_class("class-a");
  hello.set_threads(1);
  ASSERT_TRUE(stream->Write(message));
  v1::UnitResult& result = *message.mutable_result();
  result.set_job(7);  // of no job: each is answered with words
  *result.mutable_unit() = farm::to_wire(core::Unit{0, {0, 0, 8, 8}, {0, 1}});
  result.set_digest(farm::to_wire(core::Sha256{}));
  int written = 0;
  while (written < 1'000'000 && stream->Write(message)) ++written;
  EXPECT_GT(written, 50'000) << "many answers may wait";
  EXPECT_LT(written, 1'000'000) << "but not any number of them";
  v1::CoordinatorMessage reply;
  while (stream->Read(&reply)) {
  }
  EXPECT_FALSE(stream->Finish().ok());
  EXPECT_NE(world.submit(1), 0U) << "others are served";
}

TEST_F(Limits, LargeRequestsAreLookedAtOneAtATime) {
  v1::FindMissingRequest request;
  for (int i = 0; i < 10'000; ++i) {
    auto& file = *request.add_files();
    file.set_sha256(farm::to_wire(core::sha256(std::to_string(i))));
    file.set_size(1);
  }
  std::atomic<int> served{0};
  std::atomic<int> sent_away{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 5; ++i) {
        v1::FindMissingResponse response;
        const auto status = world.assets->FindMissing(world.context().get(), request, &response);
        if (status.ok()) {
          ++served;
          continue;
        }
        EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
        EXPECT_EQ(farm::detail_of(status).retry_after_ms(), 500U);
        EXPECT_TRUE(farm::is_retryable(status));
        ++sent_away;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(served, 0);
  EXPECT_GT(sent_away, 0) << "nobody met another";
}

TEST(PartCount, CountsMessagesTextsAndWhatIsUnknown) {
  const auto few = [](const std::string& bytes, const google::protobuf::Descriptor& type,
                      uint64_t most) {
    const grpc::Slice slice(bytes);
    return farm::has_few_parts(grpc::ByteBuffer(&slice, 1), type, most);
  };
  v1::SubmitRequest request;
  for (int i = 0; i < 10; ++i) request.mutable_spec()->add_files()->set_path("a path");
  const std::string bytes = request.SerializeAsString();
  EXPECT_TRUE(few(bytes, *request.descriptor(), 11));
  EXPECT_FALSE(few(bytes, *request.descriptor(), 10));
  EXPECT_FALSE(few(bytes.substr(0, bytes.size() - 1), *request.descriptor(), 11)) << "cut off";
  v1::Hello hello;
  for (int i = 0; i < 10; ++i) hello.add_tags("");
  EXPECT_TRUE(few(hello.SerializeAsString(), *hello.descriptor(), 10));
  EXPECT_FALSE(few(hello.SerializeAsString(), *hello.descriptor(), 9));
  EXPECT_FALSE(few(hello.SerializeAsString(), *v1::InfoRequest::descriptor(), 9)) << "unknown";
  EXPECT_TRUE(few("", *hello.descriptor(), 0));
}

TEST(WorkerBytes, CountAllButTheFilm) {
  const auto besides = [](const std::string& bytes) {
    const grpc::Slice slice(bytes);
    return bytes_besides_film(grpc::ByteBuffer(&slice, 1));
  };
  v1::WorkerMessage message;
  message.mutable_result()->set_film(std::string(1'000'000, 'f'));
  message.mutable_result()->set_job(7);
  message.mutable_result()->add_notes("note");
  const std::string whole = message.SerializeAsString();
  EXPECT_EQ(besides(whole), whole.size() - 1'000'000);
  EXPECT_FALSE(besides(whole.substr(0, whole.size() - 3))) << "cut off";
  message.mutable_heartbeat()->set_memory_bytes(5);  // no film any more
  EXPECT_EQ(besides(message.SerializeAsString()), message.ByteSizeLong());
  message.mutable_hello()->set_name("x");
  message.mutable_hello()->set_host(std::string(1000, 'h'));  // its field 4 is no film
  EXPECT_EQ(besides(message.SerializeAsString()), message.ByteSizeLong());
  EXPECT_EQ(besides(""), 0U);
}

}  // namespace
}  // namespace hyades::coordinator
