// What workers hold while the coordinator is away is theirs when it is back.
#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "farm/backoff.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

/// Time runs faster here: the outage and the waits of workers are this much shorter.
constexpr int kFaster = 10;
/// ... and what the coordinator waits for them only this much: else a busy machine had less than a
/// quarter of a second to connect a worker in.
constexpr int kLessFaster = 2;

TEST(Adoption, AfterHalfAMinuteWithoutACoordinatorUnitsStayWithTheirWorkers) {
  EXPECT_LE(farm::kLongestReconnect + 1500ms, ControllerOptions().adoption_time)
      << "the last to try again has to be connected, too";
  FarmWorld world;
  world.options.unit_time = 1ms;  // a batch: so there are many units
  world.options.adoption_time = ControllerOptions().adoption_time / kLessFaster;
  world.start();
  std::string text = FarmWorld::document(1);
  text.replace(text.find("[80, 48]"), 8, "[1280, 768]");  // 720 units
  world.submit_text(text);
  constexpr uint32_t kWorkers = 8;  // few, so that one does not keep the door open for the next
  std::vector<std::unique_ptr<ScriptedWorker>> workers;
  for (uint32_t i = 0; i < kWorkers; ++i) {
    ScriptedWorker::Script script = world.script();
    script.id = "scripted-worker-" + std::to_string(1000 + i);
    script.threads = 8;
    script.hold = true;
    script.backoff.emplace(farm::kFirstReconnect / kFaster, farm::kLongestReconnect / kFaster, i);
    workers.push_back(std::make_unique<ScriptedWorker>(world.address, script));
  }
  const auto sum = [&](auto what) {
    uint64_t all = 0;
    for (const auto& worker : workers) all += what(*worker);
    return all;
  };
  const auto held = [&] { return sum([](const auto& w) { return w.unacknowledged(); }); };
  const uint64_t expected = uint64_t{kWorkers} * 8;
  ASSERT_TRUE(eventually([&] { return held() >= expected; })) << held();

  world.stop();
  const uint64_t before = held();
  std::this_thread::sleep_for(30s / kFaster);
  world.start();
  // Who holds nothing is there at once, and would take everything.
  ScriptedWorker::Script script = world.script();
  script.id = "scripted-worker-9999";
  script.threads = 500;
  script.hold = true;
  const ScriptedWorker thief(world.address, script);
  ASSERT_TRUE(eventually([&] { return thief.unacknowledged() > 0; }));
  // Their leases may still be on the way.
  const auto adopted = [&] { return sum([](const auto& w) { return w.adopted(); }); };
  EXPECT_TRUE(eventually([&] { return adopted() * 10 >= before * 9; }))
      << adopted() << " of " << before << ": others render them again";
}

TEST(Adoption, WithoutOpenJobsNobodyIsWaitedFor) {
  FarmWorld world;
  world.options.adoption_time = 1h;
  world.start();
  world.stop();
  world.start();
  const uint64_t job = world.submit(1);
  const ScriptedWorker worker(world.address, world.script());
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
}

}  // namespace
}  // namespace hyades::coordinator
