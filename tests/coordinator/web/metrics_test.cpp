// What /metrics tells.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

/// The value of a row; -1 where there is none.
double value_of(const std::string& page, const std::string& row) {
  const size_t at = page.find("\n" + row + " ");
  return at == std::string::npos ? -1 : std::stod(page.substr(at + row.size() + 2));
}

size_t rows_of(const std::string& page, const std::string& start) {
  size_t count = 0;
  for (size_t at = page.find("\n" + start); at != std::string::npos;
       at = page.find("\n" + start, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Metrics, CountWhatHappens) {
  WebWorld world;
  world.farm.options.unit_time = std::chrono::milliseconds(1);
  world.start();
  std::string page = world.client->get("/metrics").body;
  EXPECT_EQ(value_of(page, R"(hyades_results_total{verdict="accepted"})"), 0)
      << "told before the first one";
  const uint64_t job = world.farm.submit(2);
  ScriptedWorker::Script script = world.farm.script();
  std::atomic<int> bad{0};
  script.meddle = [&](ScriptedWorker& worker, const v1::LeasedUnit& leased) {
    if (bad++ > 0) return true;
    v1::WorkerMessage message;
    v1::UnitResult& result = *message.mutable_result();
    *result.mutable_lease() = leased.lease();
    result.set_job(leased.job());
    *result.mutable_unit() = leased.unit();
    result.set_film("no film");
    result.set_digest(std::string(32, 'x'));
    result.set_want(1);
    worker.write(message);
    return false;
  };
  const ScriptedWorker worker(world.farm.address, script);
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_EQ(world.client->get("/nothing/here").status, 404);
  page = world.client->get("/metrics").body;
  const double accepted = value_of(page, R"(hyades_results_total{verdict="accepted"})");
  EXPECT_GT(accepted, 1);
  EXPECT_EQ(value_of(page, R"(hyades_results_total{verdict="damaged"})"), 1);
  EXPECT_GE(value_of(page, R"(hyades_leased_units_total{adopted="no"})"), accepted);
  EXPECT_GT(value_of(page, "hyades_film_bytes_total"), 0);
  EXPECT_EQ(value_of(page, "hyades_merge_seconds_count"), accepted);
  EXPECT_EQ(value_of(page, "hyades_result_seconds_count"), accepted);
  EXPECT_GE(value_of(page, "hyades_film_sync_seconds_count"), 1);
  EXPECT_EQ(value_of(page, "hyades_finish_seconds_count"), 2);
  EXPECT_EQ(value_of(page, R"(hyades_grpc_calls_total{code="OK",method="Jobs/Submit"})"), 1);
  EXPECT_EQ(value_of(page, R"(hyades_grpc_call_seconds_count{method="Jobs/Submit"})"), 1);
  EXPECT_GT(value_of(page, R"(hyades_grpc_received_bytes_total{method="Work/Attend"})"), 0);
  EXPECT_GT(value_of(page, R"(hyades_grpc_sent_bytes_total{method="Work/Attend"})"), 0);
  EXPECT_EQ(value_of(page, R"(hyades_http_requests_total{code="404",method="any",route="none"})"),
            1);
  EXPECT_GE(value_of(page, R"(hyades_http_request_seconds_count{route="/metrics"})"), 1);
  EXPECT_GT(value_of(page, "hyades_http_sent_bytes_total"), 0);
  EXPECT_EQ(value_of(page, "hyades_http_connections"), 1) << "this one";
}

TEST(Metrics, TellWorkersThatAreLostFromThoseThatLeave) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(1);
  ScriptedWorker::Script leaver = world.farm.script(1);
  leaver.reconnect = false;
  leaver.threads = 1;
  leaver.meddle = [](ScriptedWorker& worker, const v1::LeasedUnit&) {
    v1::WorkerMessage message;
    message.mutable_leaving()->set_reason("the machine is wanted");
    worker.write(message);
    return false;
  };
  ScriptedWorker::Script victim = world.farm.script(2);
  victim.reconnect = false;
  victim.hold = true;
  const auto gone = [&] {
    return value_of(world.client->get("/metrics").body, R"(hyades_workers{state="gone"})");
  };
  {
    const ScriptedWorker worker(world.farm.address, leaver);
    ASSERT_TRUE(eventually([&] {
      const Json workers = world.json("/api/v1/workers")["workers"];
      return !workers.empty() && workers[0]["reason"] == "the machine is wanted";
    }));
  }
  ASSERT_TRUE(eventually([&] { return gone() == 1; }));
  EXPECT_EQ(value_of(world.client->get("/metrics").body, "hyades_workers_lost_total"), 0);
  {
    const ScriptedWorker worker(world.farm.address, victim);
    ASSERT_TRUE(eventually([&] { return world.farm.get(job).job().leased() > 0; }));
  }
  ASSERT_TRUE(eventually([&] { return gone() == 2; }));
  EXPECT_EQ(value_of(world.client->get("/metrics").body, "hyades_workers_lost_total"), 1);
}

TEST(Metrics, DoNotGrowWithWhatOthersSend) {
  WebWorld world;
  world.start();
  (void)world.client->get("/metrics");
  const std::string before = world.client->get("/metrics").body;
  for (int i = 0; i < 30; ++i) {
    (void)world.client->get("/x" + std::to_string(i));
    (void)world.client->get("/api/v1/jobs/" + std::to_string(1000 + i));
    (void)world.client->send("BREW" + std::to_string(i), "/api/v1/info");
  }
  const std::string after = world.client->get("/metrics").body;
  EXPECT_LE(rows_of(after, "hyades_http_requests_total"),
            rows_of(before, "hyades_http_requests_total") + 4);
}

TEST(Metrics, AreWhatPrometheusTakes) {
  if (std::system("command -v promtool >/dev/null") != 0) GTEST_SKIP() << "promtool is not here";
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(1);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const std::string file = world.farm.folder.file("metrics");
  std::ofstream(file) << world.client->get("/metrics").body;
  EXPECT_EQ(std::system(("promtool check metrics <" + file).c_str()), 0);
}

}  // namespace
}  // namespace hyades::coordinator
