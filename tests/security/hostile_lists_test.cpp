// Lists that a hostile coordinator lets have no end, or far more in them than they take to send.
#include <string>
#include <vector>

#include "cli/client/farm_client.h"
#include "coordinator/access/audit_chain.h"
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

using HostileLists = Client;

// Two bytes of an empty worker took five hundred here.
TEST_F(HostileLists, OfEmptyRowsAreNotParsed) {
  add_job("a");
  farm_.workers.resize(250'000);
  const Ran ran = run(workers_command, at({}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "too many parts")) << ran.err;
  EXPECT_EQ(farm_.calls, 1) << "to ask again would not help";

  v1::WatchEvent& told = farm_.events.emplace_back(event(v1::JOB_STATE_RUNNING, 0));
  for (int i = 0; i < 250'000; ++i) told.add_changed();
  const Ran watched = run(watch_command, at({"1"}));
  EXPECT_EQ(watched.status, kFailed);
  EXPECT_TRUE(has(watched.err, "too many parts")) << watched.err;
}

TEST_F(HostileLists, OfAsManyAsAFarmMayHaveCome) {
  farm_.workers.resize(20'000);
  EXPECT_EQ(run(workers_command, at({"--names"})).status, kDone);
}

TEST_F(HostileLists, WhoseStepsHaveNoEndEndTheTrace) {
  add_job("a");
  farm_.endless_steps = true;
  const std::string file = folder_.file("trace.json");
  Ran ran = run(trace_command, at({"1", "-o", file}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "more steps than one keeps")) << ran.err;
  EXPECT_LT(farm_.calls, 200);
  const json trace = json::parse(read_file(file), nullptr, false);
  ASSERT_TRUE(trace.is_object()) << "what has come is a whole document";
  size_t workers = 0;
  for (const json& one : trace.at("traceEvents")) {
    if (one.at("name") != "process_name") continue;
    ++workers;
    EXPECT_LT(one.at("args").at("name").get<std::string>().size(), 250U);
  }
  EXPECT_LE(workers, 20'002U);

  farm_.endless_steps = false;
  farm_.same_steps = true;
  farm_.calls = 0;
  ran = run(trace_command, at({"1", "-o", folder_.file("again.json")}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "steps whose numbers do not grow")) << ran.err;
  EXPECT_LT(farm_.calls, 20);
}

TEST_F(HostileLists, WhoseNumbersDoNotGrowEnd) {
  add_job("a");
  v1::Frame& frame = farm_.frames.emplace_back();
  frame.set_frame(3);
  farm_.turns = true;
  const Ran status = run(status_command, at({"1"}));
  EXPECT_EQ(status.status, kFailed);
  EXPECT_TRUE(has(status.err, "frames whose numbers do not grow")) << status.err;
  const Ran jobs = run(jobs_command, at({"--json"}));
  EXPECT_EQ(jobs.status, kFailed);
  EXPECT_TRUE(has(jobs.err, "jobs whose numbers do not fall")) << jobs.err;
  EXPECT_LT(farm_.calls, 10);
}

TEST_F(HostileLists, OfTheSameFileTwiceAreRefused) {
  farm_.asks_twice = true;
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "or twice for one")) << ran.err;
  EXPECT_EQ(farm_.uploaded, 0U);
}

TEST_F(HostileLists, OfMissingFilesDoNotFeedPatience) {
  farm_.no_uploads = true;
  const auto begun = std::chrono::steady_clock::now();
  const Ran ran = submit({"--patience", "1"});
  EXPECT_EQ(ran.status, kNoAnswer) << ran.err;
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
}

TEST_F(HostileLists, OfUnknownLogsAreNotKept) {
  for (int i = 0; i < 3000; ++i) {
    v1::AuditEntry& entry = farm_.audited.emplace_back();
    entry.set_deed("job.cancel");
    entry.set_log(i == 0 ? "audit" : std::to_string(i) + std::string(1000, 'x'));
  }
  const Ran ran = run(audit_command, at({"--verify"}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.out, "xxx...: the entry of")) << ran.out.substr(0, 300);
  EXPECT_TRUE(has(ran.out, "is of a log that there is not"));
  EXPECT_LT(ran.out.size(), 400'000U) << "of the first thousand it is told";
  EXPECT_TRUE(has(ran.out, "... and 1,999 more")) << ran.out.substr(ran.out.size() - 500);

  coordinator::AuditChains chains;
  for (const v1::AuditEntry& entry : farm_.audited) (void)chains.add(entry);
  EXPECT_EQ(chains.ends().size(), 3U);
}

TEST_F(HostileLists, OfLinesWithoutDigestsAreToldToBeSo) {
  for (int i = 0; i < 2; ++i) {
    v1::AuditEntry& entry = farm_.audited.emplace_back();
    entry.set_deed("job.cancel");
    entry.set_log("audit");
  }
  const Ran ran = run(audit_command, at({"--verify"}));
  EXPECT_EQ(ran.status, kDone) << "a coordinator of before there were chains wrote such lines";
  EXPECT_TRUE(has(ran.out, "; 2 of them hold no digest")) << ran.out;
  EXPECT_TRUE(has(ran.out, "\nrefusals: 0 lines\nuploads: 0 lines\n")) << ran.out;
}

}  // namespace
}  // namespace hyades::cli
