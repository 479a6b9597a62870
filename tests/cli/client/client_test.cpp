#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/client/commands.h"
#include "cli/client/failure.h"
#include "cli/client/fetch.h"
#include "cli/client/patience.h"
#include "core/base/hash.h"
#include "farm/wire.h"
#include "tests/cli/client/fake_farm.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TempFolder;

struct Ran {
  int status = -1;
  std::string out;
  std::string err;
};

using Command = int (*)(int, char**);

Ran run(Command command, std::vector<std::string> words) {
  words.insert(words.begin(), "command");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Ran ran;
  ran.status = command(static_cast<int>(argv.size()), argv.data());
  std::fflush(nullptr);
  ran.out = ::testing::internal::GetCapturedStdout();
  ran.err = ::testing::internal::GetCapturedStderr();
  return ran;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string read_file(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string digest_of(const std::string& bytes) {
  return farm::to_wire(core::sha256(std::string_view(bytes)));
}

v1::WatchEvent event(v1::JobState state, uint64_t samples_done, const std::string& reason = "") {
  v1::WatchEvent event;
  v1::Job& job = *event.mutable_job();
  job.set_id(1);
  job.set_name("tri");
  job.set_frames(2);
  job.set_state(state);
  job.set_samples(100);
  job.set_samples_done(samples_done);
  job.set_reason(reason);
  return event;
}

class Client : public ::testing::Test {
 protected:
  Client() {
    mesh_ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + std::string(3'000'000, '#') + "\n";
    fs::create_directories(folder_.file("m"));
    std::ofstream(folder_.file("m/tri.obj")) << mesh_;
    std::ofstream(folder_.file("job.yaml"))
        << "hyades: 1\nname: tri\nframes: {range: 1-10}\nobjects: {a: {mesh: m/tri.obj}}\n"
           "outputs: [{file: tri.####.exr}]\n";
  }

  /// The command's words and where the farm is.
  std::vector<std::string> at(std::vector<std::string> words) const {
    words.insert(words.end(), {"--coordinator", farm_.address()});
    return words;
  }
  Ran submit(std::vector<std::string> words = {}) const {
    words.insert(words.begin(), folder_.file("job.yaml"));
    return run(submit_command, at(words));
  }
  void add_job(const std::string& name, v1::JobState state = v1::JOB_STATE_RUNNING) {
    v1::Job job;
    job.set_id(farm_.jobs.size() + 1);
    job.set_name(name);
    job.set_owner("ann");
    job.set_state(state);
    farm_.jobs.push_back(job);
  }

  TempFolder folder_;
  std::string mesh_;
  FakeFarm farm_;
};

TEST_F(Client, SubmitBringsWhatIsMissing) {
  const Ran ran =
      submit({"--priority", "7", "--owner", "bob", "--frames", "2-6x2", "--samples", "32"});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(has(ran.out, "job 1: tri")) << ran.out;
  ASSERT_EQ(farm_.submitted.size(), 1U);
  const v1::SubmitRequest request = farm_.submitted[0];
  EXPECT_EQ(request.owner(), "bob");
  EXPECT_EQ(request.priority(), 7);
  EXPECT_EQ(request.spec().samples(), 32U);
  EXPECT_EQ(request.spec().document(), "job.yaml");
  ASSERT_EQ(request.spec().files_size(), 2);
  EXPECT_EQ(request.spec().files(1).path(), "m/tri.obj");
  ASSERT_EQ(request.spec().frames_size(), 1);
  EXPECT_EQ(request.spec().frames(0).last(), 6);
  EXPECT_EQ(request.spec().frames(0).step(), 2);
  EXPECT_GE(request.idempotency_key().size(), 16U);
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);

  const uint64_t before = farm_.uploaded;
  EXPECT_EQ(submit({"--json"}).status, kDone);
  EXPECT_EQ(farm_.uploaded, before);  // all is there
  ASSERT_EQ(farm_.submitted.size(), 2U);
  EXPECT_NE(farm_.submitted[1].idempotency_key(), request.idempotency_key());
}

TEST_F(Client, UploadsGoOnWhereTheyBroke) {
  farm_.upload_cut = 1'500'000;
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
  // Sent twice is at most the piece that the break fell into.
  EXPECT_LT(farm_.uploaded, mesh_.size() + (size_t{1} << 20));
}

TEST_F(Client, UploadsBeginAgainWhereTheirBeginningIsLost) {
  farm_.upload_cut = 1'500'000;
  farm_.lose_partial = true;
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
}

TEST_F(Client, UploadsThatArriveDamagedAreSentAgain) {
  farm_.damage_upload = true;
  EXPECT_EQ(submit().status, kDone);
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
}

TEST_F(Client, FilesForgottenMeanwhileAreBroughtAgain) {
  farm_.forget_files = 1;
  EXPECT_EQ(submit().status, kDone);
  farm_.forget_files = 100;
  EXPECT_EQ(submit().status, kFailed);
}

TEST_F(Client, BadJobsGoNowhere) {
  std::ofstream(folder_.file("job.yaml")) << "hyades: 1\nobjects: {a: {mesh: m/gone.obj}}\n";
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "job.yaml:2:")) << ran.err;
  EXPECT_EQ(farm_.calls, 0);
}

TEST_F(Client, FramesOutsideTheJobAreRefused) {
  const Ran ran = submit({"--frames", "5-11"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "within the job's range 1-10")) << ran.err;
}

TEST_F(Client, WatchEndsWithTheJob) {
  farm_.events = {event(v1::JOB_STATE_RUNNING, 0), event(v1::JOB_STATE_RUNNING, 50),
                  event(v1::JOB_STATE_DONE, 100)};
  EXPECT_EQ(submit({"--watch"}).status, kDone);
  farm_.break_streams = 2;  // comes again after each break
  EXPECT_EQ(run(watch_command, at({"1"})).status, kDone);

  farm_.events.back() = event(v1::JOB_STATE_FAILED, 60);
  v1::Frame& frame = *farm_.events.back().add_changed();
  frame.set_frame(2);
  frame.set_state(v1::FRAME_STATE_FAILED);
  frame.set_reason("no memory");
  const Ran failed = run(watch_command, at({"tri"}));
  EXPECT_EQ(failed.status, kFailed);
  EXPECT_TRUE(has(failed.err, "frame 2 failed: no memory")) << failed.err;

  farm_.events.back() = event(v1::JOB_STATE_CANCELLED, 60);
  EXPECT_EQ(run(watch_command, at({"1", "--quiet"})).status, kCancelled);
}

TEST_F(Client, SubmitAndWatchPrintsTheJobAsItEnds) {
  farm_.events = {event(v1::JOB_STATE_RUNNING, 50), event(v1::JOB_STATE_FAILED, 60)};
  const Ran ran = submit({"--watch", "--json"});
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_EQ(json::parse(ran.out)["state"], "failed") << ran.out;
  EXPECT_EQ(json::parse(ran.out)["samples_done"], 60);
}

TEST_F(Client, NobodyThereIsSaidInOneLine) {
  const auto begin = std::chrono::steady_clock::now();
  const Ran ran = run(jobs_command, {"--coordinator", "127.0.0.1:1"});
  EXPECT_EQ(ran.status, kNoAnswer);
  EXPECT_TRUE(has(ran.err, "no coordinator answers at 127.0.0.1:1")) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST_F(Client, AStartingCoordinatorIsWaitedFor) {
  farm_.unavailable = 3;
  EXPECT_EQ(run(jobs_command, at({})).status, kDone);
  EXPECT_EQ(farm_.calls, 4);
}

TEST_F(Client, TheCoordinatorComesFromTheEnvironment) {
  ::setenv("HYADES_COORDINATOR", farm_.address().c_str(), 1);
  EXPECT_EQ(run(jobs_command, {}).status, kDone);
  ::unsetenv("HYADES_COORDINATOR");
}

TEST_F(Client, WrongAddressesAreWrongArguments) {
  const Ran ran = run(jobs_command, {"--coordinator", "127.0.0.1:99999"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "expected HOST:PORT")) << ran.err;
  ::setenv("HYADES_COORDINATOR", "127.0.0.1", 1);
  EXPECT_EQ(run(jobs_command, {}).status, kBadArguments);
  ::unsetenv("HYADES_COORDINATOR");
}

TEST_F(Client, TokensOpenTheDoor) {
  farm_.token = "0123456789abcdef";
  const Ran none = run(jobs_command, at({}));
  EXPECT_EQ(none.status, kRefused);
  EXPECT_TRUE(has(none.err, "--token-file")) << none.err;
  std::ofstream(folder_.file("token")) << "fedcba9876543210\n";
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("token")})).status, kRefused);
  std::ofstream(folder_.file("token")) << farm_.token << "\n";
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("token")})).status, kDone);
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("gone")})).status, kBadArguments);
}

TEST_F(Client, PlainTextStaysOnThisMachine) {
  const Ran ran = run(jobs_command, {"--coordinator", "farm.example:7700"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "--insecure")) << ran.err;
}

TEST_F(Client, JobsAreListed) {
  for (const char* name : {"a", "b", "c", "d", "e"}) add_job(name);
  farm_.jobs[1].set_state(v1::JOB_STATE_DONE);
  farm_.jobs[2].set_owner("bob");
  const json open = json::parse(run(jobs_command, at({"--json"})).out);
  ASSERT_EQ(open.size(), 4U);
  EXPECT_EQ(open[0]["id"], 5);
  EXPECT_EQ(open[0]["state"], "running");
  EXPECT_EQ(json::parse(run(jobs_command, at({"--json", "--all"})).out).size(), 5U);
  EXPECT_EQ(json::parse(run(jobs_command, at({"--json", "--owner", "bob"})).out).size(), 1U);
  EXPECT_TRUE(has(run(jobs_command, at({"--all"})).out, "done"));
}

TEST_F(Client, JobsHaveIdsAndNames) {
  add_job("forest");
  add_job("ocean");
  add_job("ocean");
  EXPECT_EQ(json::parse(run(status_command, at({"forest", "--json"})).out)["id"], 1);
  EXPECT_EQ(json::parse(run(status_command, at({"3", "--json"})).out)["id"], 3);
  const Ran typo = run(status_command, at({"forset"}));
  EXPECT_EQ(typo.status, kUnknown);
  EXPECT_TRUE(has(typo.err, "did you mean 'forest'?")) << typo.err;
  const Ran both = run(cancel_command, at({"ocean"}));
  EXPECT_EQ(both.status, kBadArguments);
  EXPECT_TRUE(has(both.err, "3, 2")) << both.err;
  EXPECT_EQ(run(status_command, at({"17"})).status, kUnknown);
}

TEST_F(Client, OfNamesakesTheOpenOneOrTheNewestIsMeant) {
  add_job("ocean", v1::JOB_STATE_DONE);
  add_job("ocean", v1::JOB_STATE_PAUSED);
  add_job("ocean", v1::JOB_STATE_FAILED);
  const Ran newest = run(status_command, at({"ocean", "--json"}));
  EXPECT_EQ(json::parse(newest.out)["id"], 3);
  EXPECT_TRUE(has(newest.err, "this is job 3")) << newest.err;
  farm_.outputs["ocean.exr"] = "wet";
  const Ran fetched = run(fetch_command, at({"ocean", "--output", folder_.file("out")}));
  EXPECT_EQ(fetched.status, kDone);
  EXPECT_TRUE(has(fetched.err, "this is job 3")) << fetched.err;
  for (const Command command : {pause_command, resume_command}) {
    const Ran ran = run(command, at({"ocean", "--json"}));
    EXPECT_EQ(json::parse(ran.out)[0]["id"], 2) << ran.err;
    EXPECT_TRUE(has(ran.err, "this is job 2")) << ran.err;
  }
  EXPECT_EQ(run(priority_command, at({"ocean", "9"})).status, kDone);
  EXPECT_EQ(farm_.jobs[1].priority(), 9);
  const Ran again = run(retry_command, at({"ocean", "--json"}));
  EXPECT_EQ(json::parse(again.out)[0]["id"], 3) << again.err;
  EXPECT_TRUE(has(again.err, "this is job 3, the only one with something to take up"));
  farm_.jobs[2].set_state(v1::JOB_STATE_DONE);
  EXPECT_EQ(run(retry_command, at({"ocean"})).status, kBadArguments) << "nothing to take up";
  farm_.jobs[1].set_frames_failed(1);
  EXPECT_EQ(json::parse(run(retry_command, at({"ocean", "--json"})).out)[0]["id"], 2);
  EXPECT_EQ(run(delete_command, at({"ocean"})).status, kBadArguments);
  EXPECT_EQ(run(cancel_command, at({"ocean"})).status, kDone);
  EXPECT_EQ(farm_.jobs[1].state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(run(cancel_command, at({"ocean"})).status, kBadArguments) << "none is open";
  EXPECT_EQ(farm_.jobs.size(), 3U);
}

TEST_F(Client, JobsAreSteered) {
  add_job("a");
  add_job("b");
  EXPECT_EQ(run(pause_command, at({"1", "b"})).status, kDone);
  EXPECT_EQ(farm_.jobs[0].state(), v1::JOB_STATE_PAUSED);
  EXPECT_EQ(farm_.jobs[1].state(), v1::JOB_STATE_PAUSED);
  EXPECT_EQ(run(resume_command, at({"1"})).status, kDone);
  EXPECT_EQ(farm_.jobs[0].state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(run(priority_command, at({"a", "9"})).status, kDone);
  EXPECT_EQ(farm_.jobs[0].priority(), 9);
  const Ran too_early = run(delete_command, at({"1"}));
  EXPECT_EQ(too_early.status, kFailed);
  EXPECT_TRUE(has(too_early.err, "has not ended")) << too_early.err;
  EXPECT_EQ(run(cancel_command, at({"1"})).status, kDone);
  EXPECT_EQ(run(retry_command, at({"1"})).status, kDone);
  EXPECT_EQ(farm_.jobs[0].state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(run(cancel_command, at({"1"})).status, kDone);
  EXPECT_EQ(run(delete_command, at({"1", "9"})).status,
            kUnknown);  // the others are done all the same
  EXPECT_EQ(farm_.jobs.size(), 1U);
}

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

  // Truncated or changed files are brought again; what an earlier run has is used.
  fs::resize_file(out + "/a.0001.exr", 100);
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

TEST_F(Client, WrongCommandLinesAreToldInOneLine) {
  const auto wrong = [&](Command command, const std::vector<std::string>& words) {
    const Ran ran = run(command, at(words));
    EXPECT_EQ(ran.status, kBadArguments) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    return ran.err;
  };
  EXPECT_EQ(
      wrong(jobs_command, {"--onwer", "ann"}),
      "hyades jobs: there is no option '--onwer', did you mean '--owner'? (hyades jobs --help "
      "tells more)\n");
  EXPECT_TRUE(has(wrong(status_command, {"a", "b"}), "'b' is one argument too many"));
  EXPECT_TRUE(has(wrong(status_command, {}), "hyades status: job is missing"));
  EXPECT_TRUE(
      has(wrong(submit_command, {"a", "--samples", "0"}), "--samples 0: expected 1 to 16777216"));
  EXPECT_TRUE(has(wrong(submit_command, {"a", "--max-workers", "x"}),
                  "--max-workers x: expected a number"));
  EXPECT_TRUE(
      has(wrong(submit_command, {"a", "--memory", "8x"}), "--memory: expected a size such as 8G"));
  EXPECT_TRUE(has(wrong(submit_command, {"a", "--order", "odd"}),
                  "--order odd: expected sequential or progressive"));
  EXPECT_TRUE(has(run(jobs_command, {"--coordinator", "a:99999"}).err,
                  "--coordinator: expected HOST:PORT"));
  EXPECT_TRUE(has(wrong(submit_command, {folder_.file("job.yaml"), "--frames", ""}),
                  "--frames: expected frames such as 7"));
  EXPECT_TRUE(
      has(wrong(jobs_command, {"--patience", "-1"}), "--patience -1: expected 0 to 1000000000"));
  EXPECT_TRUE(has(wrong(submit_command, {"gone\nhyades submit: fine.yaml"}), "gone?hyades"));
  EXPECT_TRUE(has(wrong(jobs_command, {"--token-file", "gone\ntoken"}), "gone?token"));
  EXPECT_EQ(farm_.calls, 0);
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
  for (const char* bad : {"", "/etc/x", "..", "a/../../x", "./a", "a//b", "a/", "../x"}) {
    EXPECT_FALSE(is_safe_output(bad)) << bad;
  }
  for (const char* good : {"a.exr", "a/b.exr", "..a", "a/..b"})
    EXPECT_TRUE(is_safe_output(good)) << good;
}

TEST_F(Client, LogsAreToldOnceAcrossBreaks) {
  add_job("a");
  farm_.break_streams = 2;
  const Ran ran = run(logs_command, at({"a", "--follow", "--json"}));
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 3) << ran.out;
  const std::string text = run(logs_command, at({"1"})).out;
  EXPECT_TRUE(has(text, "warning  frame 2  line 2")) << text;
  EXPECT_FALSE(has(text, "\033"));  // nobody's log steers the terminal
  EXPECT_TRUE(has(run(explain_command, at({"a"})).out, "no workers"));
}

TEST_F(Client, WorkersAreListedAndSteered) {
  v1::Worker worker;
  worker.set_id(4);
  worker.set_name("node1/0");
  worker.set_state(v1::WORKER_STATE_ACTIVE);
  farm_.workers = {worker};
  EXPECT_EQ(json::parse(run(workers_command, at({"--json"})).out)[0]["id"], 4);
  EXPECT_TRUE(has(run(workers_command, at({})).out, "node1/0"));
  EXPECT_EQ(run(quarantine_command, at({"node1/0", "--reason", "odd bits"})).status, kDone);
  EXPECT_EQ(farm_.workers[0].reason(), "odd bits");
  EXPECT_EQ(run(release_command, at({"node1/0"})).status, kDone);
  EXPECT_EQ(farm_.workers[0].state(), v1::WORKER_STATE_ACTIVE);
  EXPECT_EQ(run(drain_command, at({"node1/0"})).status, kDone);
  EXPECT_EQ(run(drain_command, at({"node2/0"})).status, kUnknown);
}

TEST(PatienceTest, GrowsAndEnds) {
  const auto begin = Patience::Clock::time_point();
  const auto after = [&](double s) {
    return begin +
           std::chrono::duration_cast<Patience::Clock::duration>(std::chrono::duration<double>(s));
  };
  Patience patience(2, 1000);
  const double first = patience.next_wait(begin);
  EXPECT_GT(first, 0);
  EXPECT_LE(first, 0.1);
  EXPECT_LT(patience.next_wait(after(2.0)), 0);
  patience.reached();
  for (int i = 0; i < 20; ++i) EXPECT_GT(patience.next_wait(after(100)), 0);
  EXPECT_GE(patience.next_wait(after(101)), 2.5);
  EXPECT_LE(patience.next_wait(after(102)), 5.0);
  const double asked = patience.next_wait(after(103), 60);
  EXPECT_GE(asked, 62.5) << "not with all others that were asked";
  EXPECT_LE(asked, 65);
  EXPECT_LT(patience.next_wait(after(1200)), 0);
}

}  // namespace
}  // namespace hyades::cli
