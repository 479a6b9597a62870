// A finisher that was taken over by what a job has it open: what it tells, and does to its files.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

/// A farm whose finisher does its work, and then what the test has it do: a script in which R is
/// its folder, O that of the job's outputs and D the coordinator's.
class LyingFinisher : public ::testing::Test {
 protected:
  void start(const std::string& lie) {
    const std::string program = world_.farm.folder.file("finisher");
    std::ofstream(program) << "#!/bin/bash\n"
                           << "R=$2 D=" << world_.farm.options.folder << "\nO=$D/outputs/1\n"
                           << HYADES_FILM_PROGRAM << " \"$@\" || exit 1\n"
                           << lie << "\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    world_.farm.options.finisher = program;
    world_.start();
    std::ofstream(world_.farm.options.folder + "/secret") << kSecret;
  }
  /// Of one frame, which is tried once.
  uint64_t job() {
    return world_.farm.submit(1, [](v1::SubmitRequest& r) { r.set_max_attempts(1); });
  }
  /// Why the job fails.
  std::string reason() {
    const uint64_t id = job();
    EXPECT_EQ(id, 1U);
    const ScriptedWorker worker(world_.farm.address, world_.farm.script());
    EXPECT_TRUE(world_.farm.wait_for(id, v1::JOB_STATE_FAILED));
    const auto outputs = world_.json("/api/v1/jobs/1/outputs")["outputs"];
    EXPECT_TRUE(outputs.empty()) << outputs;
    return world_.farm.get(id).job().reason();
  }
  /// A script that tells of one more file.
  static std::string tell(const std::string& path, const std::string& size) {
    return "sed -i '1s|\\[|[{\"path\": \"" + path + "\", \"size\": '" + size + "', \"sha256\": \"" +
           std::string(64, 'a') + "\"},|' $R/result.json";
  }

  static constexpr const char* kSecret = "what nobody is to read";
  WebWorld world_;
};

TEST_F(LyingFinisher, TellsOfNoFilesThatItWasNotToMake) {
  start(tell("../../secret", "22"));
  const std::string why = reason();
  EXPECT_NE(why.find("not to make: '../../secret'"), std::string::npos) << why;
  const auto got = world_.client->get("/api/v1/jobs/1/outputs/..%2F..%2Fsecret");
  EXPECT_EQ(got.status, 404);
  EXPECT_EQ(got.body.find(kSecret), std::string::npos) << got.body;
}

TEST_F(LyingFinisher, TellsOfNoFileTwice) {
  start(tell("balls.0001.png", "$(stat -c %s $O/balls.0001.png)"));
  const std::string why = reason();
  EXPECT_NE(why.find("not to make: 'balls.0001.png'"), std::string::npos) << why;
}

TEST_F(LyingFinisher, PutsNoLinkInAFilesPlace) {
  start("cp $O/balls.0001.png $D/other; ln -sf $D/other $O/balls.0001.png");
  const std::string why = reason();
  EXPECT_NE(why.find("balls.0001.png: is a link"), std::string::npos) << why;
}

TEST_F(LyingFinisher, MakesFilesAsLongAsItSays) {
  start("truncate -s 7 $O/balls.0001.png");
  const std::string why = reason();
  EXPECT_NE(why.find("balls.0001.png: has 7 bytes, not "), std::string::npos) << why;
}

TEST_F(LyingFinisher, FillsNoMemoryWithItsResult) {
  start("truncate -s 1T $R/result.json");
  const std::string why = reason();
  EXPECT_NE(why.find("result: has 1099511627776 bytes, more than "), std::string::npos) << why;
}

TEST_F(LyingFinisher, SaysNothingThatOthersHaveWritten) {
  start("ln -sf $D/secret $R/said.txt; exit 1");
  const std::string why = reason();
  EXPECT_NE(why.find("the finisher failed (1)"), std::string::npos) << why;
  EXPECT_EQ(why.find(kSecret), std::string::npos) << why;
}

}  // namespace
}  // namespace hyades::coordinator
