// What a coordinator that is hostile, or was taken over, can do to those who fetch from it.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cli/client/farm_client.h"
#include "cli/client/find_job.h"
#include "core/film/film.h"
#include "core/film/film_codec.h"
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

using HostileCoordinator = Client;

TEST_F(HostileCoordinator, WritesNoHiddenFiles) {
  add_job("a", v1::JOB_STATE_DONE);
  const std::string out = folder_.file("out");
  for (const char* path :
       {".bashrc", ".ssh/authorized_keys", ".git/hooks/post-checkout", "-rf", "a/.b/c.exr"}) {
    farm_.outputs = {{path, "evil"}};
    const Ran ran = run(fetch_command, at({"a", "--output", out}));
    EXPECT_EQ(ran.status, kFailed) << path;
    EXPECT_TRUE(has(ran.err, "(--hidden writes them)")) << ran.err;
    EXPECT_FALSE(fs::exists(out + "/" + path));
  }
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out, "--hidden"})).status, kDone);
  EXPECT_TRUE(fs::exists(out + "/a/.b/c.exr"));
}

TEST_F(HostileCoordinator, WritesNothingButWhatJobsHave) {
  add_job("a", v1::JOB_STATE_DONE);
  const std::string out = folder_.file("out");
  for (const char* path : {"json.py", "a/Makefile", "a.exr.sh", "a.EXR~", "exr"}) {
    farm_.outputs = {{path, "evil"}};
    const Ran ran = run(fetch_command, at({"a", "--output", out, "--hidden"}));
    EXPECT_EQ(ran.status, kFailed) << path;
    EXPECT_TRUE(has(ran.err, std::string(path) + ": no job has such an output; expected the "
                                                 "ending .exr"))
        << ran.err;
    EXPECT_FALSE(fs::exists(out + "/" + path));
  }
  farm_.outputs = {{"a.EXR", "1"}, {"b/a.film.exr", "2"}, {"c.webm", "3"}};
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kDone);
}

TEST_F(HostileCoordinator, ReachesNoTerminalByWordsOfRefusal) {
  farm_.full = 1;
  farm_.full_words = "\x1b]0;OWNED\x07\x1b[2J\u202e\u009b31m";
  const Ran ran = run(jobs_command, at({}));
  EXPECT_EQ(ran.status, kDone);
  EXPECT_TRUE(has(ran.err, "trying for up to")) << ran.err;
  for (const char* raw : {"\x1b", "\x07", "\u202e", "\u009b"}) EXPECT_FALSE(has(ran.err, raw));
}

TEST_F(HostileCoordinator, ReachesNoTerminalByJson) {
  add_job("\x1b[31m\u009b31m\u202egnp.exe");
  const Ran ran = run(jobs_command, at({"--json"}));
  EXPECT_EQ(ran.status, kDone);
  EXPECT_TRUE(has(ran.out, "\\u202egnp.exe")) << ran.out;
  for (const char* raw : {"\x1b", "\u202e", "\u009b"}) EXPECT_FALSE(has(ran.out, raw));
}

TEST_F(HostileCoordinator, IsNotToldWhatIsInHiddenFiles) {
  add_job("a", v1::JOB_STATE_DONE);
  const std::string out = folder_.file("out");
  fs::create_directories(out);
  std::ofstream(out + "/.netrc") << "guessed";
  for (const char* guess : {"guessed", "wrong"}) {
    farm_.outputs = {{".netrc", guess}};
    const Ran ran = run(fetch_command, at({"a", "--output", out}));
    EXPECT_EQ(ran.status, kFailed) << guess;
    EXPECT_TRUE(has(ran.err, "(--hidden writes them)")) << ran.err;
  }
}

TEST_F(HostileCoordinator, FillsNoMemoryByWhatHasNoEnd) {
  add_job("a");
  farm_.endless = true;
  farm_.films.emplace(1, core::Film(core::make_film_layout({}), {0, 0, 8, 8}));
  ClientOptions options;
  options.peer.address = farm_.address();
  options.most_bytes = 1'000'000;
  const auto client = FarmClient::open(options);
  ASSERT_TRUE(client.ok());
  v1::GetJobResponse job;
  v1::WorkersResponse workers;
  std::vector<v1::Job> jobs;
  v1::FilmHeader header;
  std::string film;
  for (const Outcome& outcome :
       {(*client)->get(1, job), (*client)->workers(workers),
        list_all_jobs(**client, true, "", jobs), (*client)->film(1, 1, header, film)}) {
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->code, kFailed);
    EXPECT_TRUE(has(outcome->message, "half of the memory here")) << outcome->message;
  }
  EXPECT_LT(farm_.calls, 40);
}

// A few bytes that stand for a large film, which `fetch --film` and `watch --display` unpack.
TEST_F(HostileCoordinator, FillsNoMemoryByAFilmThatIsPackedWell) {
  add_job("a");
  core::Film black(core::make_film_layout({}), {0, 0, 256, 256});
  const std::vector<float> values(size_t{256} * 256 *
                                  static_cast<size_t>(black.layout().deposited));
  black.deposit({0, 0, 256, 256}, 0, 16, values);
  farm_.films.emplace(1, black);
  const auto unpacked = [&](uint64_t most_bytes) {
    ClientOptions options;
    options.peer.address = farm_.address();
    options.most_bytes = most_bytes;
    const auto client = FarmClient::open(options);
    EXPECT_TRUE(client.ok());
    v1::FilmHeader header;
    std::string bytes;
    EXPECT_FALSE((*client)->film(1, 1, header, bytes)) << "it comes whole";
    EXPECT_LT(bytes.size(), black.memory() / 10);
    return core::decode_film(std::as_bytes(std::span(bytes)), (*client)->film_limits(bytes)).ok();
  };
  EXPECT_FALSE(unpacked(black.memory() / 2));
  EXPECT_TRUE(unpacked(black.memory() * 4));
}

// gRPC looks at how long a message is when it has unpacked it.
TEST_F(HostileCoordinator, SendsNoPackedMessages) {
  add_job(std::string(1000, 'a'));  // which is shorter when it is packed
  farm_.packs = true;
  const Ran ran = run(jobs_command, at({}));
  EXPECT_EQ(ran.status, kFailed) << ran.out;
  EXPECT_FALSE(has(ran.out, "ann")) << ran.out;
}

TEST_F(HostileCoordinator, FillsNoMemoryByFramesThatFail) {
  add_job("a");
  farm_.events.clear();
  for (int32_t hundred = 30; hundred-- > 0;) {  // the first come last
    v1::WatchEvent& told = farm_.events.emplace_back(
        event(hundred > 0 ? v1::JOB_STATE_RUNNING : v1::JOB_STATE_FAILED, 0));
    told.mutable_job()->set_frames_failed(12);
    for (int32_t frame = 0; frame < 100; ++frame) {
      v1::Frame& failed = *told.add_changed();
      failed.set_frame(100 * hundred + frame);
      failed.set_state(v1::FRAME_STATE_FAILED);
      failed.set_reason("broken");
    }
  }
  const Ran ran = run(watch_command, at({"1"}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "frame 0 failed: broken\n")) << ran.err;
  EXPECT_TRUE(has(ran.err, "frame 9 failed: broken\n")) << ran.err;
  EXPECT_FALSE(has(ran.err, "frame 10 failed")) << ran.err;
  EXPECT_TRUE(has(ran.err, "... and 2 more")) << "as the job says, for no others are kept";
}

TEST_F(HostileCoordinator, ReplacesNoFileThatFetchHasNotWritten) {
  add_job("a", v1::JOB_STATE_DONE);
  const std::string out = folder_.file("out");
  fs::create_directories(out);
  std::ofstream(out + "/thesis.tif") << "mine";
  farm_.outputs = {{"thesis.tif", "evil"}};
  const Ran ran = run(fetch_command, at({"a", "--output", out}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "thesis.tif (--overwrite replaces it")) << ran.err;
  EXPECT_EQ(read_file(out + "/thesis.tif"), "mine");

  // What was fetched is replaced by a later rendering, also by a later run.
  farm_.outputs = {{"a.exr", "first"}};
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kDone);
  farm_.outputs = {{"a.exr", "second"}};
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kDone);
  EXPECT_EQ(read_file(out + "/a.exr"), "second");

  // Links are not followed to what they lead to.
  std::ofstream(folder_.file("elsewhere")) << "mine";
  fs::create_symlink(folder_.file("elsewhere"), out + "/link.exr");
  farm_.outputs = {{"link.exr", "evil"}};
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kFailed);
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out, "--overwrite"})).status, kDone);
  EXPECT_EQ(read_file(folder_.file("elsewhere")), "mine");
  EXPECT_EQ(read_file(out + "/link.exr"), "evil");
}

}  // namespace
}  // namespace hyades::cli
