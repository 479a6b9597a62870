#include "cli/film_commands.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {
namespace {

class CompareCommand : public ::testing::Test {
 protected:
  /// A picture of one value, with variances where `variance` is not negative.
  std::string write(const std::string& name, float value, float variance = -1.0F, int size = 32) {
    std::vector<std::string> channels{"R", "G", "B"};
    if (variance >= 0.0F) {
      channels.insert(channels.end(), {"variance.R", "variance.G", "variance.B"});
    }
    core::Image image = core::make_image(size, size, channels);
    for (size_t i = 0; i < image.data.size(); ++i) {
      image.data[i] = i % channels.size() < 3 ? value : variance;
    }
    EXPECT_TRUE(core::write_exr(path(name), image).ok());
    return path(name);
  }

  std::string path(const std::string& name) const { return folder_.file(name); }

  /// Exit status; standard output and error come in out_ and err_.
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "compare");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int status = compare_command(static_cast<int>(argv.size()), argv.data());
    out_ = ::testing::internal::GetCapturedStdout();
    err_ = ::testing::internal::GetCapturedStderr();
    return status;
  }

  test::TempFolder folder_;
  std::string out_;
  std::string err_;
};

TEST_F(CompareCommand, TolerancesDecideTheStatus) {
  const std::string a = write("a.exr", 1.02F);
  const std::string b = write("b.exr", 1.0F);
  EXPECT_EQ(run({a, b}), 0);
  EXPECT_NE(out_.find("2.000 %"), std::string::npos) << out_;
  EXPECT_EQ(run({a, b, "--tolerance", "0.021"}), 0);
  EXPECT_EQ(run({a, b, "--tolerance", "0.019"}), 1);
  EXPECT_NE(err_.find("mean of a channel"), std::string::npos);
  EXPECT_EQ(run({a, b, "--block-tolerance", "0.019"}), 1);
  EXPECT_NE(err_.find("mean of a block"), std::string::npos);
  EXPECT_EQ(run({a, a, "--tolerance", "0", "--block-tolerance", "0"}), 0);
}

TEST_F(CompareCommand, VariancesDecideTheStatus) {
  const std::string b = write("b.exr", 1.0F, 1e-4F);
  const std::string near = write("near.exr", 1.0005F, 1e-4F);
  const std::string far = write("far.exr", 1.01F, 1e-4F);
  EXPECT_EQ(run({near, b, "--least-p", "0.01"}), 0);
  EXPECT_EQ(run({far, b, "--least-p", "0.01"}), 1);
  EXPECT_NE(err_.find("variances"), std::string::npos);
  EXPECT_EQ(run({write("plain.exr", 1.0F), b, "--least-p", "0.01"}), 2);
}

TEST_F(CompareCommand, CropsCompareWhereBothShowTheFrame) {
  core::Image whole = core::make_image(8, 6, {"R", "G", "B"});
  for (size_t i = 0; i < whole.data.size(); ++i) whole.data[i] = static_cast<float>(i);
  core::Image part = core::cut_out(whole, 2, 1, 4, 3);
  part.placement = {2, 1, 8, 6};
  core::Image beside = core::cut_out(whole, 5, 1, 3, 3);
  beside.placement = {5, 1, 8, 6};
  core::Image away = core::cut_out(whole, 6, 4, 2, 2);
  away.placement = {6, 4, 8, 6};
  EXPECT_TRUE(core::write_exr(path("whole.exr"), whole).ok());
  EXPECT_TRUE(core::write_exr(path("part.exr"), part).ok());
  EXPECT_TRUE(core::write_exr(path("beside.exr"), beside).ok());
  EXPECT_TRUE(core::write_exr(path("away.exr"), away).ok());
  EXPECT_EQ(run({path("part.exr"), path("whole.exr")}), 0);
  EXPECT_NE(out_.find("4 x 3 pixels, identical"), std::string::npos) << out_;
  EXPECT_EQ(run({path("part.exr"), path("beside.exr")}), 0);
  EXPECT_NE(out_.find("1 x 3 pixels, identical"), std::string::npos) << out_;
  EXPECT_EQ(run({path("part.exr"), path("away.exr")}), 2);
  EXPECT_NE(err_.find("different parts"), std::string::npos) << err_;
  EXPECT_EQ(run({path("part.exr"), write("other.exr", 1.0F)}), 2);
  EXPECT_NE(err_.find("8 x 6 and 32 x 32"), std::string::npos) << err_;
}

TEST_F(CompareCommand, JsonAndErrorImage) {
  const std::string a = write("a.exr", 2.0F);
  const std::string b = write("b.exr", 1.0F);
  ASSERT_EQ(run({a, b, "--json", "--error-image", path("e.png")}), 0) << err_;
  EXPECT_EQ(out_.front(), '{');
  EXPECT_NE(out_.find("\"mean_a\": 2.0"), std::string::npos) << out_;
  EXPECT_TRUE(core::read_image_file(path("e.png")));
  ASSERT_EQ(run({a, a, "--json"}), 0);
  EXPECT_NE(out_.find("\"psnr\": null"), std::string::npos) << "infinity is not JSON: " << out_;
  EXPECT_EQ(run({a, b, "--error-image", path("e.tga")}), 2);
}

TEST_F(CompareCommand, WrongArgumentsAreStatusTwo) {
  const std::string a = write("a.exr", 1.0F);
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({a}), 2);
  EXPECT_EQ(run({a, path("none.exr")}), 2);
  EXPECT_NE(err_.find("none.exr: no such file"), std::string::npos) << err_;
  EXPECT_EQ(run({a, write("small.exr", 1.0F, -1.0F, 16)}), 2);
  EXPECT_NE(err_.find("differ in size"), std::string::npos) << err_;
  EXPECT_EQ(run({a, a, "--layer", "albedo"}), 2);
  EXPECT_EQ(run({a, a, "--tolerance", "-1"}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_NE(out_.find("exit status"), std::string::npos);
}

}  // namespace
}  // namespace hyades::cli
