// A disk that fills up while a frame's outputs are written.
#include <unistd.h>

#include <fstream>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kBudget = uint64_t{512} << 20U;

/// A finisher that takes all the room that the coordinator's folder may have, and fails as one does
/// that has none, until there is a file `go`.
class NoRoom : public testing::Test {
 protected:
  void SetUp() override {
    world.options.disk.budget = kBudget;
    std::ofstream script(finisher_);
    script << "#!/bin/sh\n"
           << "if [ -e " << go_ << " ]; then rm -f " << ballast() << "; exec "
           << HYADES_FILM_PROGRAM << " \"$@\"; fi\n"
           << "fallocate -l " << kBudget << " " << ballast() << "\n"
           << "echo tried >> " << tries_ << "\n"
           << "echo 'balls.0001.exr: No space left on device' >&2\nexit 1\n";
    script.close();
    std::filesystem::permissions(finisher_, std::filesystem::perms::owner_all);
    world.options.finisher = finisher_;
  }
  std::string ballast() const { return world.options.folder + "/ballast"; }
  int tries() const {
    std::ifstream in(tries_);
    int n = 0;
    for (std::string line; std::getline(in, line);) ++n;
    return n;
  }

  FarmWorld world;
  const std::string finisher_ = world.folder.file("finisher");
  const std::string go_ = world.folder.file("go");
  const std::string tries_ = world.folder.file("tries");
};

TEST_F(NoRoom, ForTheOutputsIsWaitedForAndFailsNoFrame) {
  world.start();
  const uint64_t job = world.submit(1, [](v1::SubmitRequest& r) { r.set_max_attempts(1); });
  const ScriptedWorker worker(world.address, world.script());
  // More often than a frame may fail.
  ASSERT_TRUE(eventually(
      [&] { return tries() >= 2 || world.get(job).job().state() == v1::JOB_STATE_FAILED; }));
  const v1::Job waits = world.get(job).job();
  ASSERT_EQ(waits.frames_failed(), 0U) << waits.reason();
  EXPECT_NE(waits.reason().find("waits for room on the disk"), std::string::npos) << waits.reason();
  // The room is there again with the next try: one that fails meanwhile finds none.
  std::ofstream(go_) << "go";
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE)) << world.get(job).job().reason();
  world.expect_truth(job, 1);
}

}  // namespace
}  // namespace hyades::coordinator
