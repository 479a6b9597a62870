// Outputs that are cut off or replaced while the coordinator reads them: whoever finishes a frame
// of a job may write to the files of all its frames.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "coordinator/web/zip_source.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kLong = uint64_t{256} << 20U;  ///< more than is on its way at a time

/// A farm with a job of one frame, whose picture is long.
class CutOffOutput : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string program = world_.farm.folder.file("finisher");
    std::ofstream(program) << "#!/bin/bash\nO=" << file() << "\n"
                           << HYADES_FILM_PROGRAM << " \"$@\" || exit 1\n"
                           << "sed -i \"s/\\\"size\\\": $(stat -c %s $O)\\b/\\\"size\\\": " << kLong
                           << "/\" $2/result.json\ntruncate -s " << kLong << " $O\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    world_.farm.options.finisher = program;
    world_.start();
    ASSERT_EQ(world_.farm.submit(1), 1U);
    const ScriptedWorker worker(world_.farm.address, world_.farm.script());
    ASSERT_TRUE(world_.farm.wait_for(1, v1::JOB_STATE_DONE)) << world_.farm.get(1).job().reason();
    ASSERT_EQ(std::filesystem::file_size(file()), kLong);
  }
  std::string file() const { return world_.farm.options.folder + "/outputs/1/balls.0001.png"; }
  /// How a fetch ends during which `change` is made.
  template <class Change>
  grpc::Status fetch(Change change) const {
    v1::FetchRequest request;
    request.set_job(1);
    request.set_path("balls.0001.png");
    const auto c = world_.farm.context();
    const auto reader = world_.farm.jobs->Fetch(c.get(), request);
    v1::Chunk chunk;
    EXPECT_TRUE(reader->Read(&chunk));
    change();
    while (reader->Read(&chunk)) {
    }
    return reader->Finish();
  }

  WebWorld world_;
};

TEST_F(CutOffOutput, EndsTheFetchAndNothingElse) {
  const grpc::Status cut = fetch([&] { std::filesystem::resize_file(file(), 10); });
  EXPECT_EQ(cut.error_code(), grpc::StatusCode::DATA_LOSS) << cut.error_message();
  EXPECT_NE(cut.error_message().find("balls.0001.png is damaged"), std::string::npos);
  world_.farm.expect_truth(1, 1);
}

TEST_F(CutOffOutput, IsNotTakenFromAnotherFile) {
  const std::string other = world_.farm.folder.file("other");
  std::ofstream(other) << "what nobody is to read";
  std::filesystem::resize_file(other, kLong);
  const auto link = [&] {
    std::filesystem::remove(file());
    std::filesystem::create_symlink(other, file());
  };
  const grpc::Status replaced = fetch(link);
  EXPECT_EQ(replaced.error_code(), grpc::StatusCode::DATA_LOSS) << replaced.error_message();
  for (const char* path : {"outputs/balls.0001.png", "archive.zip"}) {
    const auto got = world_.client->get(std::string("/api/v1/jobs/1/") + path);
    EXPECT_FALSE(got.status == 200 && got.whole) << path;
    EXPECT_EQ(got.body.find("what nobody is to read"), std::string::npos) << path;
  }
}

TEST(CutOffFile, BreaksAnArchiveOff) {
  const test::TempFolder folder;
  std::ofstream(folder.file("a.png")) << std::string(3'000'000, 'x');
  ZipSource source(folder.path());
  source.add("a.png", 3'000'000);
  ASSERT_TRUE(source.next());
  std::filesystem::resize_file(folder.file("a.png"), 10);
  EXPECT_FALSE(source.next());
}

TEST(CutOffFile, IsNotReachedThroughLinkedFolders) {
  const test::TempFolder folder;
  std::filesystem::create_directories(folder.file("other"));
  std::filesystem::create_directories(folder.file("outputs/frames"));
  std::ofstream(folder.file("other/a.png")) << "other";
  std::ofstream(folder.file("outputs/frames/a.png")) << "own";
  std::filesystem::create_symlink(folder.file("other"), folder.file("outputs/linked"));
  const std::string outputs = folder.file("outputs");
  EXPECT_TRUE(core::MadeFile::find(outputs, "frames/a.png").ok());
  EXPECT_FALSE(core::MadeFile::find(outputs, "linked/a.png").ok());
  EXPECT_FALSE(core::MadeFile::find(outputs, "../other/a.png").ok());
  EXPECT_FALSE(core::MadeFile::find(outputs, folder.file("other/a.png")).ok());
  EXPECT_FALSE(core::MadeFile::find(outputs, "frames").ok());
}

}  // namespace
}  // namespace hyades::coordinator
