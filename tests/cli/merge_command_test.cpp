#include "cli/film_commands.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/film/film_exr.h"
#include "tests/core/film/film_testing.h"

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;

class MergeCommand : public ::testing::Test {
 protected:
  MergeCommand() {
    folder_ = fs::path(::testing::TempDir()) /
              ("hyades_merge_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MergeCommand() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const core::PixelRect& tile, core::BatchRange batches,
             const std::string& key = "k") const {
    core::FilmFile file{{"fog", key, 7, 20, 10, {0, 0, 20, 10}, 64, "c", "b", {}},
                        core::render(core::make_film_layout({}), tile, batches, 64)};
    ASSERT_TRUE(core::write_film_exr(path(name), file).ok());
  }

  /// Exit status; standard output and error come in out_ and err_.
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "merge");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int status = merge_command(static_cast<int>(argv.size()), argv.data());
    out_ = ::testing::internal::GetCapturedStdout();
    err_ = ::testing::internal::GetCapturedStderr();
    return status;
  }

  fs::path folder_;
  std::string out_;
  std::string err_;
};

TEST_F(MergeCommand, JoinsWhatFitsInAnyOrder) {
  write("whole.exr", {0, 0, 20, 10}, {0, 4});
  write("a.exr", {0, 0, 12, 10}, {0, 4});
  write("b.exr", {12, 0, 20, 10}, {0, 1});
  write("c.exr", {12, 0, 20, 10}, {1, 3});
  ASSERT_EQ(run({path("a.exr"), path("b.exr"), path("c.exr"), "-o", path("abc.exr")}), 0) << err_;
  EXPECT_EQ(out_, path("abc.exr") + ": frame 7 of fog: 3 films, 100 % of 64 samples per pixel\n");
  ASSERT_EQ(run({path("c.exr"), path("b.exr"), "-q", "-o", path("cb.exr")}), 0) << err_;
  EXPECT_EQ(out_, "");
  ASSERT_EQ(run({path("cb.exr"), path("a.exr"), "--output", path("cba.exr")}), 0) << err_;
  const std::string digest = core::read_film_exr(path("whole.exr"))->film.digest();
  EXPECT_EQ(core::read_film_exr(path("abc.exr"))->film.digest(), digest);
  EXPECT_EQ(core::read_film_exr(path("cba.exr"))->film.digest(), digest);
}

TEST_F(MergeCommand, SaysWhichFileDoesNotFitWhichAndWhy) {
  write("a.exr", {0, 0, 12, 10}, {0, 2});
  write("b.exr", {12, 0, 20, 10}, {0, 2});
  write("key.exr", {0, 0, 12, 10}, {2, 2}, "other");
  write("again.exr", {14, 0, 20, 10}, {1, 2});
  EXPECT_EQ(run({path("a.exr"), path("key.exr"), "-o", path("out.exr")}), 2);
  EXPECT_NE(err_.find(path("key.exr") + " does not fit " + path("a.exr") + ": the render key"),
            std::string::npos)
      << err_;
  EXPECT_EQ(run({path("a.exr"), path("b.exr"), path("again.exr"), "-o", path("out.exr")}), 2);
  EXPECT_NE(err_.find(path("again.exr") + " does not fit " + path("b.exr") +
                      ": both films hold batches 1 to 1 of pixels x 14 to 19, y 0 to 9"),
            std::string::npos)
      << err_;
  EXPECT_FALSE(fs::exists(path("out.exr")));
}

TEST_F(MergeCommand, BadUseIsRefusedAndHelpShowsAnExample) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({path("a.exr")}), 2);
  EXPECT_NE(err_.find("--output"), std::string::npos);
  EXPECT_EQ(run({path("none.exr"), "-o", path("out.exr")}), 2);
  EXPECT_NE(err_.find("none.exr"), std::string::npos);
  write("a.exr", {0, 0, 12, 10}, {0, 2});
  EXPECT_EQ(run({path("a.exr"), "-o", path("no/out.exr")}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_NE(out_.find("hyades merge north.0007.exr south.0007.exr -o"), std::string::npos);
}

}  // namespace
}  // namespace hyades::cli
