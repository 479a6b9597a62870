// Lists of jobs and workers, their names, and what is done to them.
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

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
  EXPECT_EQ(run(jobs_command, at({"--names"})).out, "e\nd\nc\na\n");
  farm_.jobs[0].set_state(v1::JOB_STATE_PAUSED);
  farm_.jobs[3].set_state(v1::JOB_STATE_CANCELLED);
  farm_.jobs[4].set_name("c");
  const auto offered = [&](const char* command) {
    return run(jobs_command, at({"--all", "--names", "--for", command})).out;
  };
  EXPECT_EQ(offered("status"), "5\nd\n3\nb\na\n") << "two are called c";
  EXPECT_EQ(offered("resume"), "a\n");
  EXPECT_EQ(offered("cancel"), "5\n3\na\n");
  EXPECT_EQ(offered("retry"), "d\n");
  EXPECT_EQ(offered("delete"), "d\nb\n");
}

TEST_F(Client, JobsThatEndedLastAreListedWithWhatTheyTook) {
  for (int i = 0; i < 8; ++i) add_job("old" + std::to_string(i), v1::JOB_STATE_DONE);
  for (int i = 0; i < 8; ++i) farm_.jobs[static_cast<size_t>(i)].set_ended_ms(1000 * (8 - i));
  v1::Job& old = farm_.jobs[0];
  old.set_submitted_ms(-3'600'000);
  old.set_begun_ms(-2000);
  old.set_core_seconds(5400);
  old.set_cost(3.1);
  add_job("open");
  const std::string text = run(jobs_command, at({})).out;
  for (const char* told : {"old0", "old4", "open", "10.0 s", "1.50 (3.10)"}) {
    EXPECT_TRUE(has(text, told)) << text;
  }
  EXPECT_FALSE(has(text, "old5")) << "that ended before five others: " << text;
}

TEST_F(Client, WaitingIsNotWhatAJobTook) {
  add_job("ocean");
  v1::Job& job = farm_.jobs[0];
  job.set_samples(100);
  EXPECT_TRUE(has(run(status_command, at({"ocean"})).out, "took       -\ncore-hours -\n"));
  job.set_begun_ms(1000);
  job.set_samples_done(40);
  job.set_busy_seconds(1.25);
  job.set_core_seconds(2.5);
  const std::string text = run(status_command, at({"ocean"})).out;
  EXPECT_TRUE(has(text, "took       1.25 s\ncore-hours < 0.01\n")) << text;
}

TEST_F(Client, AJobThatNobodyRendersWaits) {
  add_job("ocean");
  farm_.jobs[0].set_waiting(true);
  farm_.jobs[0].set_seconds_left(77);
  for (const Command command : {jobs_command, status_command}) {
    const std::string text = run(command, command == jobs_command ? at({}) : at({"ocean"})).out;
    EXPECT_TRUE(has(text, "waiting")) << text;
    EXPECT_FALSE(has(text, "1 min 17 s")) << text;
  }
  EXPECT_TRUE(has(run(priority_command, at({"ocean", "5"})).out, "is waiting, priority 5"));
  EXPECT_EQ(json::parse(run(status_command, at({"ocean", "--json"})).out)["waiting"], true);
  farm_.jobs[0].set_waiting(false);
  EXPECT_TRUE(has(run(jobs_command, at({})).out, "running"));
  EXPECT_TRUE(has(run(status_command, at({"ocean"})).out, "1 min 17 s left"));
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
  EXPECT_TRUE(has(again.err, "this is job 3, the only one with something to retry"));
  farm_.jobs[2].set_state(v1::JOB_STATE_DONE);
  EXPECT_EQ(run(retry_command, at({"ocean"})).status, kBadArguments) << "nothing to retry";
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
  const Ran typo = run(drain_command, at({"node2/0"}));
  EXPECT_EQ(typo.status, kUnknown);
  EXPECT_TRUE(has(typo.err, "did you mean 'node1/0'?")) << typo.err;
}

}  // namespace
}  // namespace hyades::cli
