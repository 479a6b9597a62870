// What fetch brings, and what it says of what it does not.
#include <sys/stat.h>

#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

TEST_F(Client, FetchChecksAndGoesOn) {
  add_job("a", v1::JOB_STATE_DONE);
  farm_.outputs["a.0001.exr"] = std::string(5'000, 'x') + std::string(5'000, 'y');
  farm_.outputs["passes/a.0002.exr"] = "two";
  farm_.break_streams = 1;
  const std::string out = folder_.file("out");
  Ran ran = run(fetch_command, at({"a", "--output", out}));
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_EQ(read_file(out + "/a.0001.exr"), farm_.outputs["a.0001.exr"]);
  EXPECT_EQ(read_file(out + "/passes/a.0002.exr"), "two");
  EXPECT_EQ(farm_.fetched, 10'003U);

  run(fetch_command, at({"a", "--output", out}));
  EXPECT_EQ(farm_.fetched, 10'003U);  // all is there

  // What was there is brought again; what an earlier run has is used.
  fs::remove(out + "/a.0001.exr");
  const std::string sha = core::to_hex(core::sha256(std::string_view(farm_.outputs["a.0001.exr"])));
  const std::string part = out + "/.a.0001.exr." + sha.substr(0, 16) + ".part";
  std::ofstream(part) << std::string(4'000, 'x');
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kDone);
  EXPECT_EQ(farm_.fetched, 16'003U);
  EXPECT_EQ(read_file(out + "/a.0001.exr"), farm_.outputs["a.0001.exr"]);
  EXPECT_FALSE(fs::exists(part));

  // A damaged part costs a second round.
  fs::remove(out + "/a.0001.exr");
  std::ofstream(part) << std::string(4'000, '!');
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kDone);
  EXPECT_EQ(read_file(out + "/a.0001.exr"), farm_.outputs["a.0001.exr"]);
  EXPECT_EQ(json::parse(run(fetch_command, at({"a", "--list", "--json"})).out)[1]["id"],
            "passes/a.0002.exr");
}

TEST_F(Client, FetchReplacesOnlyWhatItHasWrittenOfTheSameJob) {
  add_job("a", v1::JOB_STATE_DONE);
  add_job("b", v1::JOB_STATE_DONE);
  farm_.outputs["a.exr"] = "one";
  farm_.outputs["b.exr"] = "two";
  const std::string out = folder_.file("out");
  const auto fetch = [&](const std::string& job, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{job, "--output", out};
    words.insert(words.end(), more.begin(), more.end());
    return run(fetch_command, at(words));
  };
  ASSERT_EQ(fetch("1").status, kDone);
  farm_.outputs["a.exr"] = "once more";  // after a retry
  EXPECT_EQ(fetch("1").status, kDone);
  EXPECT_EQ(read_file(out + "/a.exr"), "once more");

  std::ofstream(out + "/a.exr") << "edited";
  farm_.outputs["b.exr"] = "new";
  Ran ran = fetch("1");
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "1 file is there")) << ran.err;
  EXPECT_TRUE(has(ran.err, "a.exr (--overwrite replaces it")) << ran.err;
  EXPECT_EQ(read_file(out + "/a.exr"), "edited");
  EXPECT_EQ(read_file(out + "/b.exr"), "new") << "the others come";

  farm_.outputs = {{"a.exr", "another's"}, {"b.exr", "another's"}};
  ran = fetch("2");
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "2 files are there")) << ran.err;
  EXPECT_TRUE(has(ran.err, "a.exr, b.exr (--overwrite")) << ran.err;
  EXPECT_EQ(read_file(out + "/b.exr"), "new");
  // Another coordinator's first job is not this one's.
  farm_.jobs[0].set_submitted_ms(5);
  EXPECT_EQ(fetch("1").status, kFailed);
  EXPECT_EQ(fetch("2", {"--overwrite"}).status, kDone);
  EXPECT_EQ(read_file(out + "/a.exr"), "another's");
}

TEST_F(Client, FetchSaysWhyThereIsNothing) {
  add_job("a", v1::JOB_STATE_DONE);
  v1::Frame frame;
  frame.set_frame(1);
  farm_.frames = {frame};
  for (const Command command : {fetch_command, logs_command}) {
    const Ran ran = run(command, at({"1", "--frame", "1,99"}));
    EXPECT_EQ(ran.status, kUnknown);
    EXPECT_TRUE(has(ran.err, "job 1 has no frame 99")) << ran.err;
  }
  EXPECT_EQ(run(logs_command, at({"1", "--frame", "1"})).status, kDone);
  const auto why = [&](v1::JobState state) {
    farm_.jobs[0].set_state(state);
    const Ran ran = run(fetch_command, at({"1", "--frame", "1"}));
    EXPECT_EQ(ran.status, kFailed);
    return ran.err;
  };
  const std::string failed = why(v1::JOB_STATE_FAILED);
  EXPECT_TRUE(has(failed, "job 1 failed")) << failed;
  EXPECT_TRUE(has(failed, "hyades retry 1")) << failed;
  EXPECT_TRUE(has(why(v1::JOB_STATE_CANCELLED), "was cancelled"));
  EXPECT_TRUE(has(why(v1::JOB_STATE_RUNNING), "nothing to fetch yet"));
}

TEST_F(Client, FetchSaysWhichFramesFailedOrAreMissing) {
  add_job("a", v1::JOB_STATE_FAILED);
  for (int i = 1; i <= 5; ++i) {
    v1::Frame frame;
    frame.set_frame(i);
    frame.set_state(i == 2 || i > 3 ? v1::FRAME_STATE_FAILED : v1::FRAME_STATE_DONE);
    farm_.frames.push_back(frame);
  }
  farm_.outputs["a.0001.exr"] = "one";
  const std::vector<std::string> words = at({"a", "--output", folder_.file("out")});
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return run(fetch_command, all);
  };
  Ran ran = with({});
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "frames 2, 4-5 failed and have no files")) << ran.err;
  EXPECT_TRUE(has(ran.err, "hyades retry 1")) << ran.err;
  EXPECT_EQ(read_file(folder_.file("out/a.0001.exr")), "one") << "what there is comes first";
  ran = with({"--json", "--quiet"});
  EXPECT_EQ(ran.status, kFailed) << "the same for scripts";
  EXPECT_EQ(json::parse(ran.out).size(), 1U);
  EXPECT_EQ(with({"--frame", "1,3"}).status, kDone) << "they are all right";
  EXPECT_EQ(with({"--frames", "1-3x2"}).status, kDone) << "the same";
  EXPECT_TRUE(has(with({"--frames", "1,3-5"}).err, "frames 4-5 failed"));
  for (const char* wrong : {"3-1", "1,", "1-3x0", "1 2"}) {
    ran = with({"--frames", wrong});
    EXPECT_EQ(ran.status, kBadArguments) << wrong;
    EXPECT_TRUE(has(ran.err, "expected a ")) << ran.err;
    EXPECT_TRUE(has(ran.err, std::string("--frames ") + wrong)) << ran.err;
    EXPECT_EQ(ran.err.find("--frames"), ran.err.rfind("--frames")) << ran.err;
  }
  EXPECT_EQ(with({"--list"}).status, kDone);

  farm_.jobs[0].set_state(v1::JOB_STATE_RUNNING);
  for (v1::Frame& frame : farm_.frames) {
    if (frame.state() == v1::FRAME_STATE_FAILED) frame.set_state(v1::FRAME_STATE_RENDERING);
  }
  ran = with({});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(has(ran.err, "3 frames are not finished yet (--follow waits for them)")) << ran.err;
  farm_.jobs[0].set_state(v1::JOB_STATE_CANCELLED);
  ran = with({});
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "was cancelled when 0 of its")) << ran.err;

  farm_.outputs.clear();
  ran = with({"--json"});
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_EQ(ran.out, "[]\n");
  EXPECT_TRUE(has(ran.err, "there is nothing to fetch")) << ran.err;
  ran = with({"--json", "--list"});
  EXPECT_EQ(ran.status, kDone);
  EXPECT_EQ(ran.out, "[]\n");
}

TEST_F(Client, FetchKeepsNothingThatIsWrong) {
  add_job("a", v1::JOB_STATE_DONE);
  farm_.outputs["a.exr"] = "right";
  farm_.damage_fetch = true;
  const Ran ran = run(fetch_command, at({"a", "--output", folder_.file("out")}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "SHA-256")) << ran.err;
  EXPECT_FALSE(fs::exists(folder_.file("out/a.exr")));
}

TEST_F(Client, FetchStaysInItsFolder) {
  add_job("a", v1::JOB_STATE_DONE);
  farm_.outputs["../stolen.exr"] = "evil";
  EXPECT_EQ(run(fetch_command, at({"a", "--output", folder_.file("out")})).status, kFailed);
  EXPECT_FALSE(fs::exists(folder_.file("stolen.exr")));
  for (const char* bad : {"", "/etc/x", "..", "a/../../x", "./a", "a//b", "a/", "../x",
                          "a\\..\\b.exr", "\\\\host\\b.exr"}) {
    EXPECT_FALSE(is_safe_output(bad)) << bad;
  }
  for (const char* good : {"a.exr", "a/b.exr", "..a", "a/..b"})
    EXPECT_TRUE(is_safe_output(good)) << good;
  EXPECT_FALSE(is_safe_output("a\nb.exr"));
}

TEST_F(Client, FetchFollowsNoLinkOutOfItsFolder) {
  add_job("a", v1::JOB_STATE_DONE);
  farm_.outputs["pics/mine.exr"] = "evil";
  const std::string out = folder_.file("out");
  fs::create_directories(folder_.file("home"));
  std::ofstream(folder_.file("home/mine.exr")) << "mine";
  // As a folder from a stranger may be: with a record that says who wrote what.
  fs::create_directories(out + "/.hyades");
  std::ofstream(out + "/.hyades/fetched") << "pics/mine.exr\n";
  fs::create_symlink(folder_.file("home"), out + "/pics");
  for (const char* more : {"--quiet", "--overwrite"}) {
    const Ran ran = run(fetch_command, at({"a", "--output", out, more}));
    EXPECT_EQ(ran.status, kFailed);
    EXPECT_TRUE(has(ran.err, "pics: a link that leads out of the folder")) << ran.err;
  }
  EXPECT_EQ(read_file(folder_.file("home/mine.exr")), "mine");
  farm_.outputs = {{"b.exr", "good"}};
  fs::remove_all(out + "/.hyades");
  fs::create_symlink(folder_.file("home"), out + "/.hyades");
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kFailed);
  EXPECT_FALSE(fs::exists(folder_.file("home/fetched")));
  fs::remove(out + "/.hyades");
  fs::create_directories(out + "/.hyades");
  ASSERT_EQ(::mkfifo((out + "/.hyades/fetched").c_str(), 0600), 0);
  EXPECT_EQ(run(fetch_command, at({"a", "--output", out})).status, kFailed) << "it waits for ever";
}

}  // namespace
}  // namespace hyades::cli
