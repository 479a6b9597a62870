// What of a job stays on the coordinator's disk, and what goes.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "core/film/film_codec.h"
#include "core/film/film_exr.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

core::Film truth(int32_t frame) {
  return fake_film({frame,
                    {0, 0, FarmWorld::kWidth, FarmWorld::kHeight},
                    {0, core::batch_count(FarmWorld::kSamples)}},
                   FarmWorld::kSamples, core::make_film_layout({}));
}

grpc::Status fetch_film(const FarmWorld& world, uint64_t job, int32_t frame, std::string& bytes) {
  v1::FilmRequest request;
  request.set_job(job);
  request.set_frame(frame);
  const auto context = world.context();
  const auto reader = world.jobs->Film(context.get(), request);
  v1::FilmPart part;
  while (reader->Read(&part)) bytes += part.chunk().data();
  return reader->Finish();
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

}  // namespace
}  // namespace hyades::coordinator
