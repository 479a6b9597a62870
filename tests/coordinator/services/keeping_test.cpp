// What of a job stays on the coordinator's disk, and what goes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "coordinator/film_store/remove_folder.h"
#include "core/base/descriptor.h"
#include "core/film/film_codec.h"
#include "core/film/film_exr.h"
#include "tests/coordinator/services/farm_world.h"
#include "tests/coordinator/services/troubled_store.h"

namespace hyades::coordinator {
namespace {

core::Film truth(int32_t frame) {
  return fake_film({frame,
                    {0, 0, FarmWorld::kWidth, FarmWorld::kHeight},
                    {0, core::batch_count(FarmWorld::kSamples)}},
                   FarmWorld::kSamples, core::make_film_layout({}));
}

TEST(Keeping, FilmsOfFinishedFramesStayWhereTheJobSaysSo) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(FarmWorld::document(3) + "keep_films: true\n");
  const uint64_t other = world.submit(2);
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 2ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return world.get(job).job().frames_done() >= 1; }));
    std::string bytes;
    ASSERT_TRUE(fetch_film(world, job, 1, bytes).ok()) << "while the job goes on";
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
    ASSERT_TRUE(world.wait_for(other, v1::JOB_STATE_DONE));
  }
  world.stop();
  world.start();
  for (int32_t frame = 1; frame <= 3; ++frame) {
    std::string bytes;
    const grpc::Status status = fetch_film(world, job, frame, bytes);
    ASSERT_TRUE(status.ok()) << status.error_message();
    const auto film = core::decode_film(std::as_bytes(std::span(bytes)));
    ASSERT_TRUE(film.ok());
    EXPECT_EQ(film->digest(), truth(frame).digest());
  }
  // It is an output as any other, and what `hyades merge` reads.
  const std::string file = world.fetch(job, "balls.0002.film.exr");
  const std::string path = world.folder.file("film.exr");
  FILE* out = std::fopen(path.c_str(), "wb");
  std::fwrite(file.data(), 1, file.size(), out);
  std::fclose(out);
  const auto read = core::read_film_exr(path);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->film.digest(), truth(2).digest());
  EXPECT_EQ(read->info.worker_class, world.script().worker_class);

  std::string nothing;
  const grpc::Status gone = fetch_film(world, other, 1, nothing);
  EXPECT_EQ(gone.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(gone.error_message().find("keep_films"), std::string::npos) << gone.error_message();
}

// Its file may be a thousandth of what it takes in memory, black as it may be.
TEST(Keeping, AFilmThatIsTooLargeIsNotReadToBeShown) {
  FarmWorld world;
  world.options.film_memory = uint64_t{1} << 20U;
  world.start();
  const uint64_t job = world.submit_text(FarmWorld::document(1) + "keep_films: true\n");
  {
    const ScriptedWorker worker(world.address, world.script());
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  }
  std::string bytes;
  const grpc::Status status = fetch_film(world, job, 1, bytes);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(status.error_message().find("too large to be shown"), std::string::npos)
      << status.error_message();
  world.stop();
  world.options.film_memory = uint64_t{64} << 20U;
  world.start();
  EXPECT_TRUE(fetch_film(world, job, 1, bytes).ok());
}

void finish_and_delete(FarmWorld& world, uint64_t job) {
  v1::JobResponse now;
  (void)world.jobs->Cancel(world.context().get(), about(job), &now);
  v1::DeleteJobResponse gone;
  const grpc::Status status = world.jobs->Delete(world.context().get(), about(job), &gone);
  ASSERT_TRUE(status.ok()) << status.error_message();
}

std::string asset_of(const FarmWorld& world, const std::string& text) {
  return world.options.folder + "/assets/" + core::to_hex(core::sha256(text));
}

std::string folder_of(const FarmWorld& world, const std::string& kind, uint64_t job) {
  return world.options.folder + "/" + kind + "/" + std::to_string(job);
}

TEST(Keeping, WhatADeletedJobHadGoesButNotWhatOthersNeed) {
  FarmWorld world;
  world.options.asset_grace = 600ms;
  world.start();
  const std::string shared = FarmWorld::document(2);
  const std::string own = FarmWorld::document(1);
  const uint64_t first = world.submit_text(shared);
  const uint64_t second = world.submit_text(shared);
  const uint64_t third = world.submit_text(own);
  {
    const ScriptedWorker worker(world.address, world.script());
    for (const uint64_t job : {first, second, third}) {
      ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
    }
  }
  ASSERT_TRUE(std::filesystem::exists(folder_of(world, "outputs", first)));
  std::this_thread::sleep_for(1s);  // nobody uses the files; still, there are jobs that need them
  finish_and_delete(world, first);
  const auto deleted = std::chrono::steady_clock::now();
  finish_and_delete(world, third);
  EXPECT_TRUE(eventually([&] {
    return !std::filesystem::exists(folder_of(world, "outputs", first)) &&
           !std::filesystem::exists(folder_of(world, "films", first));
  }));
  ASSERT_TRUE(eventually([&] { return !std::filesystem::exists(asset_of(world, own)); }));
  EXPECT_GE(std::chrono::steady_clock::now() - deleted, 550ms) << "it stays for a while";
  std::this_thread::sleep_for(400ms);
  EXPECT_TRUE(std::filesystem::exists(asset_of(world, shared))) << "another job needs it";
  EXPECT_FALSE(world.fetch(second, "balls.0001.png").empty());
  finish_and_delete(world, second);
  // After a restart, too.
  world.stop();
  world.start();
  EXPECT_TRUE(eventually([&] { return !std::filesystem::exists(asset_of(world, shared)); }));
}

TEST(Keeping, WhatACrashLeftOfADeletedJobGoesAfterTheNextStart) {
  FarmWorld world;
  world.start();
  const uint64_t open = world.submit(4);
  const uint64_t done = world.submit(1);
  {
    ScriptedWorker::Script script = world.script();
    std::atomic<int> units{0};
    script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
      return unit.job() != open || ++units <= 3;
    };
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 3; }));
    ASSERT_TRUE(
        world.jobs
            ->Pause(world.context().get(), about(open), std::make_unique<v1::JobResponse>().get())
            .ok());
  }
  {
    const ScriptedWorker worker(world.address, world.script(2));
    ASSERT_TRUE(world.wait_for(done, v1::JOB_STATE_DONE));
  }
  world.stop();
  std::filesystem::create_directories(folder_of(world, "films", 999));
  std::filesystem::create_directories(folder_of(world, "outputs", 999) + "/png");
  std::filesystem::create_directories(folder_of(world, "films", done));
  std::filesystem::create_directories(world.options.folder + "/outputs/mine");
  world.start();
  EXPECT_TRUE(eventually([&] {
    return !std::filesystem::exists(folder_of(world, "films", 999)) &&
           !std::filesystem::exists(folder_of(world, "outputs", 999)) &&
           !std::filesystem::exists(folder_of(world, "films", done));
  }));
  EXPECT_TRUE(std::filesystem::exists(folder_of(world, "films", open)));
  EXPECT_TRUE(std::filesystem::exists(folder_of(world, "outputs", done)));
  EXPECT_TRUE(std::filesystem::exists(world.options.folder + "/outputs/mine")) << "is no job's";
  EXPECT_GT(world.get(open).job().samples_done(), 0U);
}

TEST(Keeping, WhatACrashLeftGoesThoughTheStoreDidNotAnswerAtFirst) {
  FarmWorld world;
  world.options.asset_grace = 400ms;  // it is looked for several times a second
  const auto trouble = std::make_shared<Trouble>();
  world.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  std::filesystem::create_directories(folder_of(world, "films", 999));
  trouble->of_states(Trouble::Kind::fails);
  world.start();
  ASSERT_TRUE(eventually([&] { return trouble->failed() > 0; }));
  EXPECT_TRUE(std::filesystem::exists(folder_of(world, "films", 999))) << "it may be a job's";
  trouble->of_states(Trouble::Kind::none);
  EXPECT_TRUE(eventually([&] { return !std::filesystem::exists(folder_of(world, "films", 999)); }));
}

TEST(Keeping, AJobOfManyRowsIsDeletedBesideOthers) {
  FarmWorld world;
  const auto trouble = std::make_shared<Trouble>();
  world.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  world.start();
  const uint64_t job = world.submit(1);
  const uint64_t other = world.submit(1);
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(job), &now).ok());
  std::vector<StoredOutput> outputs;
  for (int i = 0; i < 3000; ++i) outputs.push_back({std::to_string(i), 1, 9, "sha"});
  ASSERT_TRUE(world.controller->store().change_outputs(job, {}, outputs).ok());
  // As if it took for ever.
  trouble->of_drops(Trouble::Kind::waits);
  finish_and_delete(world, job);
  EXPECT_EQ(world.jobs->Pause(world.context().get(), about(job), &now).error_code(),
            grpc::StatusCode::NOT_FOUND);
  finish_and_delete(world, other);
  world.submit(2);
  EXPECT_TRUE(
      eventually([&] { return !std::filesystem::exists(folder_of(world, "outputs", job)); }));
  // Where it has not come to its end the next start goes on with it.
  trouble->of_drops(Trouble::Kind::fails);
  ASSERT_TRUE(eventually([&] { return trouble->failed() > 0; }));
  world.stop();
  world.wrap_store = nullptr;
  world.start();
  EXPECT_TRUE(eventually([&] {
    const auto more = world.controller->store().drop_removed(0);
    return more && !*more;
  }));
}

TEST(Keeping, ManyUnusedFilesGoInTurnsWithSubmissions) {
  FarmWorld world;
  world.options.asset_grace = 0ms;
  const auto trouble = std::make_shared<Trouble>();
  world.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  world.start();  // the folder is this farm's
  world.stop();
  const std::string assets = world.options.folder + "/assets";
  for (int i = 0; i < 4500; ++i) {
    std::ofstream(assets + "/" + core::to_hex(core::sha256(std::to_string(i)))) << i;
  }
  world.start();
  ASSERT_TRUE(eventually([&] {
    const auto names = world.controller->assets().names();
    return names.empty();
  }));
  // Before each thousand of them: submissions may have come in between.
  EXPECT_GE(trouble->looks(), 5);
}

TEST(Keeping, ALargeFileIsCheckedByOneThreadForAllWhoFetchIt) {
  FarmWorld world;
  const std::string name = core::to_hex(core::sha256("something else"));
  world.start();  // the folder is this farm's
  world.stop();
  std::ofstream(world.options.folder + "/assets/" + name).close();
  std::filesystem::resize_file(world.options.folder + "/assets/" + name, uint64_t{512} << 20U);
  world.start();
  std::atomic<int> told{0};
  std::vector<std::thread> workers;
  for (int i = 0; i < 8; ++i) {
    workers.emplace_back([&] {
      v1::DownloadRequest request;
      request.set_sha256(farm::to_wire(core::sha256("something else")));
      const auto context = world.context();
      const auto reader = world.assets->Download(context.get(), request);
      v1::Chunk chunk;
      EXPECT_FALSE(reader->Read(&chunk));
      const grpc::Status status = reader->Finish();
      if (status.error_code() == grpc::StatusCode::NOT_FOUND) return;
      EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << status.error_message();
      EXPECT_GT(farm::detail_of(status).retry_after_ms(), 0U);
      ++told;
    });
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_GE(told, 4);
}

TEST(Keeping, FoldersGoInPiecesAndTheirLinksAlone) {
  const test::TempFolder folder;
  const std::string job = folder.file("job");
  const std::string beside = folder.file("beside");
  for (const std::string& path : {job, beside}) {
    std::filesystem::create_directories(path + "/deep/er");
    for (int i = 0; i < 6; ++i) {
      std::ofstream(fmt::format("{}/{}", path, i)) << "x";
      std::ofstream(fmt::format("{}/deep/er/{}", path, i)) << "x";
    }
  }
  std::filesystem::create_directory_symlink(beside, job + "/link");
  std::filesystem::create_directory_symlink(beside, folder.file("other"));
  const auto files = [&] {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(job)) {
      count += entry.is_directory() && !entry.is_symlink() ? 0 : 1;
    }
    return count;
  };
  EXPECT_FALSE(remove_some(job, 5));
  EXPECT_EQ(files(), 8);
  EXPECT_FALSE(remove_some(job, 5));
  EXPECT_EQ(files(), 3);
  EXPECT_TRUE(remove_some(job, 5));
  EXPECT_FALSE(std::filesystem::exists(job));
  EXPECT_TRUE(remove_some(job, 5)) << "it is gone";
  EXPECT_TRUE(remove_some(folder.file("other"), 5));
  EXPECT_TRUE(std::filesystem::exists(beside + "/deep/er/5"));
}

TEST(Keeping, AFilmIsFoundByTheOutputsOfItsFrameAlone) {
  FarmWorld world;
  const auto trouble = std::make_shared<Trouble>();
  world.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  world.start();
  const uint64_t job = world.submit_text(FarmWorld::document(2) + "keep_films: true\n");
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  // Of a job with a million frames they are many.
  trouble->of_outputs(Trouble::Kind::fails);
  std::string bytes;
  const grpc::Status status = fetch_film(world, job, 2, bytes);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(core::decode_film(std::as_bytes(std::span(bytes)))->digest(), truth(2).digest());
}

TEST(Keeping, AJobThatWasTakenInHasItsFilesHoweverEagerTheSweeperIs) {
  FarmWorld world;
  world.options.asset_grace = 0ms;
  world.start();
  const std::string text = FarmWorld::document(1);
  int refused = 0;
  for (int i = 0; i < 30; ++i) {
    v1::SubmitResponse response;
    grpc::Status status;
    for (int round = 0; round < 20 && !response.has_job(); ++round) {
      ASSERT_TRUE(world.upload(text).ok());
      if (round % 2 == i % 2) std::this_thread::sleep_for(std::chrono::milliseconds(7 * i % 40));
      status = world.jobs->Submit(world.context().get(), FarmWorld::request(text), &response);
      refused += status.ok() ? 0 : 1;
      ASSERT_TRUE(status.ok() || farm::detail_of(status).missing_size() == 1)
          << status.error_message();
    }
    ASSERT_TRUE(status.ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(i % 3 * 60));
    EXPECT_TRUE(std::filesystem::exists(asset_of(world, text)));
    finish_and_delete(world, response.job().id());
  }
  RecordProperty("refused", refused);
}

TEST(Keeping, AJobWhoseFileIsCutOffFailsAloneUntilTheFileIsThereAgain) {
  FarmWorld world;
  world.start();
  const std::string extra = "something that frames need";
  ASSERT_TRUE(world.upload(extra).ok());
  const uint64_t job = world.submit(1, [&](v1::SubmitRequest& request) {
    v1::JobFile& file = *request.mutable_spec()->add_files();
    file.set_path("extra.ply");
    file.set_sha256(farm::to_wire(core::sha256(extra)));
    file.set_size(extra.size());
  });
  const uint64_t other = world.submit(1);
  world.stop();
  std::filesystem::resize_file(asset_of(world, extra), 10);
  world.start();
  EXPECT_EQ(world.get(other).job().state(), v1::JOB_STATE_RUNNING);
  const auto fails = [&] {
    const v1::Job now = world.get(job).job();
    EXPECT_EQ(now.state(), v1::JOB_STATE_FAILED);
    EXPECT_NE(now.reason().find("extra.ply is gone or damaged"), std::string::npos) << now.reason();
  };
  fails();
  v1::JobResponse now;
  EXPECT_EQ(world.jobs->Retry(world.context().get(), about(job), &now).error_code(),
            grpc::StatusCode::FAILED_PRECONDITION);
  fails();
  ASSERT_TRUE(world.upload(extra).ok());
  ASSERT_TRUE(world.jobs->Retry(world.context().get(), about(job), &now).ok());
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
}

TEST(Keeping, AFullDiskTakesNothingInLeasesNothingAndGoesOnByItself) {
  FarmWorld world;
  world.options.disk.budget = 20 << 20U;  // of which a twentieth is the reserve
  world.options.disk.reserve = 0;
  world.start();
  const std::string key = "0123456789abcdef";
  const uint64_t job =
      world.submit(3, [&](v1::SubmitRequest& asked) { asked.set_idempotency_key(key); });
  const std::string ballast = world.options.folder + "/ballast";
  std::ofstream(ballast) << std::string((19 << 20U) + (1 << 18U), 'x');
  const auto reason = [&] {
    v1::ExplainResponse why;
    EXPECT_TRUE(world.jobs->Explain(world.context().get(), about(job), &why).ok());
    return why.reasons(0);
  };
  ASSERT_TRUE(eventually([&] { return reason().find("--disk-budget") != std::string::npos; }));
  EXPECT_NE(reason().find("no units are leased"), std::string::npos) << reason();
  EXPECT_NE(world.get(job).job().reason().find("--disk-budget"), std::string::npos);

  const std::string text = FarmWorld::document(1);
  const grpc::Status upload = world.upload(text);
  EXPECT_EQ(upload.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << upload.error_message();
  EXPECT_NE(upload.error_message().find("--disk-budget"), std::string::npos);
  EXPECT_GT(farm::detail_of(upload).retry_after_ms(), 0U);
  v1::SubmitResponse response;
  v1::SubmitRequest request = FarmWorld::request(FarmWorld::document(3));
  const grpc::Status submit = world.jobs->Submit(world.context().get(), request, &response);
  EXPECT_EQ(submit.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << submit.error_message();
  // What it has taken in already is no new job.
  request.set_idempotency_key(key);
  const grpc::Status again = world.jobs->Submit(world.context().get(), request, &response);
  EXPECT_TRUE(again.ok()) << again.error_message();
  EXPECT_TRUE(response.existed());
  EXPECT_EQ(response.job().id(), job);

  const ScriptedWorker worker(world.address, world.script());
  std::this_thread::sleep_for(600ms);
  EXPECT_EQ(worker.delivered(), 0U);
  std::filesystem::remove(ballast);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  for (int frame = 1; frame <= 3; ++frame) world.expect_truth(job, frame);
  EXPECT_TRUE(world.upload(text).ok());
  // More than there is room for is refused before it is sent.
  v1::UploadResponse ignored;
  const auto context = world.context();
  const auto writer = world.assets->Upload(context.get(), &ignored);
  v1::UploadPart part;
  part.set_sha256(farm::to_wire(core::sha256("large")));
  part.set_size(19 << 20U);
  writer->Write(part);
  const grpc::Status large = writer->Finish();
  EXPECT_EQ(large.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << large.error_message();
  EXPECT_NE(large.error_message().find("does not fit"), std::string::npos);
}

TEST(Keeping, UploadsThatNobodyGoesOnWithDoNotHoldTheFarmUp) {
  FarmWorld world;
  world.options.disk.budget = 100U << 20U;
  world.start();
  // Begun and left, by whom one does not know.
  constexpr int kLeft = 10;
  const std::string folder = world.options.folder + "/assets/partial/";
  const std::vector<char> bytes(10U << 20U, 'x');
  // The oldest first: what was written within the last minute stays.
  for (int i = kLeft - 1; i >= 0; --i) {
    const std::string path = folder + core::to_hex(core::sha256("left " + std::to_string(i)));
    std::ofstream(path).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() - 3600s - i * 60s);
  }
  const auto left = [&] { return std::distance(std::filesystem::directory_iterator(folder), {}); };
  ASSERT_TRUE(eventually([&] { return left() < kLeft; })) << "the farm stands still for days";
  EXPECT_TRUE(eventually([&] { return world.controller->disk().admit(0).ok(); }));
  std::this_thread::sleep_for(1500ms);
  // Others write to this disk, too, and that is taken for the farm's.
  EXPECT_GT(left(), kLeft / 2) << "no more goes than has to";
  EXPECT_FALSE(std::filesystem::exists(
      folder + core::to_hex(core::sha256("left " + std::to_string(kLeft - 1)))))
      << "the oldest first";
}

TEST(Keeping, FilmsWaitWithTheirWorkersWhileTheDiskIsFull) {
  FarmWorld world;
  // What other programs write meanwhile is taken for the coordinator's, too: much more than that.
  constexpr off_t kBudget = off_t{512} << 20U;
  world.options.disk.budget = kBudget;
  world.options.disk.reserve = 0;
  world.start();
  const uint64_t job = world.submit(2);
  const std::string ballast = world.options.folder + "/ballast";
  std::atomic<bool> filled{false};
  ScriptedWorker::Script script = world.script();
  script.unit_time = 20ms;  // so that some are acknowledged before all are rendered
  script.meddle = [&](ScriptedWorker& self, const v1::LeasedUnit&) {
    if (self.acknowledged() < 3 || filled.exchange(true)) return true;
    const core::Descriptor file(::open(ballast.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
    EXPECT_EQ(::posix_fallocate(file.get(), 0, kBudget), 0);
    EXPECT_TRUE(eventually([&] { return world.controller->disk().is_full(); }));
    return true;
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return !worker.rejections().empty(); }));
  EXPECT_EQ(worker.rejections().front().reason(), v1::Rejected::REASON_NOT_NOW);
  EXPECT_GT(worker.rejections().front().retry_after_ms(), 0U);
  std::filesystem::remove(ballast);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  for (int frame = 1; frame <= 2; ++frame) world.expect_truth(job, frame);
}

}  // namespace
}  // namespace hyades::coordinator
