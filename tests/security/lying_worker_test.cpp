// What a worker with a good token can do to the pixels of a farm, and to other workers.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "coordinator/controller/lease_proof.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

core::Unit unit_at(int32_t x, uint32_t first, uint32_t count) {
  return {3, {x, 0, x + 16, 16}, {first, count}};
}

TEST(LeaseProofs, AreOfOneWorkerAndUnitAndItsParts) {
  const LeaseProofs proofs("secret");
  const JobId job{7};
  const std::string proof = proofs.make("worker-of-ada-0001", job, unit_at(0, 4, 8));
  EXPECT_TRUE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 8)));
  EXPECT_TRUE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 1))) << "its beginning";
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0002", job, unit_at(0, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", JobId{8}, unit_at(0, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(16, 4, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 0, 8)));
  EXPECT_FALSE(proofs.holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 9)));
  EXPECT_FALSE(LeaseProofs("other").holds(proof, "worker-of-ada-0001", job, unit_at(0, 4, 8)));
  for (size_t i = 0; i < proof.size(); ++i) {
    std::string changed = proof;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(proofs.holds(changed, "worker-of-ada-0001", job, unit_at(0, 4, 8))) << i;
  }
  EXPECT_FALSE(proofs.holds("", "worker-of-ada-0001", job, unit_at(0, 4, 8)));
}

/// A worker that takes nothing and delivers what it likes.
ScriptedWorker::Script idle_script(const FarmWorld& world, int number) {
  ScriptedWorker::Script script = world.script(number);
  script.meddle = [](ScriptedWorker&, const v1::LeasedUnit&) { return false; };
  return script;
}

TEST(LyingWorker, FilmsOfUnitsThatItWasNotLeasedDoNotCount) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::optional<v1::LeasedUnit> honest;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    if (!honest) honest = unit;
    return false;
  };
  const ScriptedWorker ada(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return honest.has_value();
  }));
  ScriptedWorker liar(world.address, idle_script(world, 2));
  ASSERT_TRUE(eventually([&] { return liar.streams() > 0; }));
  v1::LeasedUnit stolen = *honest;  // with ada's lease, and ada's proof
  liar.deliver(stolen);
  stolen.mutable_unit()->clear_proof();
  liar.deliver(stolen);
  stolen.mutable_lease()->set_number(999'999);
  liar.deliver(stolen);
  ASSERT_TRUE(eventually([&] { return liar.rejections().size() == 3; }));
  for (const v1::Rejected& rejected : liar.rejections()) {
    EXPECT_EQ(rejected.reason(), v1::Rejected::REASON_UNKNOWN);
    EXPECT_EQ(rejected.text(), "the unit was not leased to this worker");
  }
  EXPECT_EQ(world.get(job).job().samples_done(), 0U);
}

TEST(LyingWorker, GivesNoUnitsOfOthersBackAndBlamesNoneOfThem) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::vector<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    held.push_back(unit);
    return false;
  };
  const ScriptedWorker ada(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return !held.empty();
  }));
  const auto out = [&] { return world.get(job).job().leased(); };
  const auto before = out();
  ASSERT_GT(before, 0U);
  ScriptedWorker::Script idle = idle_script(world, 2);
  idle.threads = 1;
  ScriptedWorker liar(world.address, idle);
  ASSERT_TRUE(eventually([&] { return out() > before; }));  // it has some of its own
  const auto all = out();
  {
    const std::lock_guard lock(mutex);
    v1::WorkerMessage message;
    for (const v1::LeasedUnit& unit : held) *message.mutable_returned()->add_units() = unit;
    liar.write(message);
    for (const v1::LeasedUnit& unit : held) liar.fail(unit, "it is evil");
  }
  std::this_thread::sleep_for(200ms);
  EXPECT_GE(out(), all);
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_RUNNING);
}

TEST(LyingWorker, WhatItSaysToHaveFromBeforeARestartItHasToProve) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::mutex mutex;
  std::optional<v1::LeasedUnit> held;
  ScriptedWorker::Script script = world.script(1);
  script.hold = true;
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    held = unit;
    return true;
  };
  std::optional<ScriptedWorker> honest;
  honest.emplace(world.address, script);
  ASSERT_TRUE(eventually([&] { return honest->unacknowledged() > 0; }));
  world.stop();
  honest.reset();
  world.start();
  ScriptedWorker::Script forger = idle_script(world, 2);
  forger.claims = {*held};
  const ScriptedWorker liar(world.address, forger);
  ASSERT_TRUE(eventually([&] { return liar.stopped() > 0; }));
  EXPECT_EQ(liar.adopted(), 0U);
  ScriptedWorker::Script again = world.script(1);
  again.claims = {*held};
  const ScriptedWorker owner(world.address, again);
  EXPECT_TRUE(eventually([&] { return owner.adopted() > 0; })) << "who has a proof keeps his own";
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_RUNNING);
}

}  // namespace
}  // namespace hyades::coordinator
