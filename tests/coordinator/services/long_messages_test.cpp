// Messages of workers that name more than they have.
#include <gtest/gtest.h>

#include <mutex>
#include <vector>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

/// A worker that has units and renders none.
class LongMessages : public testing::Test {
 protected:
  void SetUp() override {
    world.options.copy_after = std::chrono::hours(1);
    world.start();
    job = world.submit(1);
    ScriptedWorker::Script script = world.script();
    script.threads = 1;
    script.meddle = [this](ScriptedWorker&, const v1::LeasedUnit& unit) {
      const std::lock_guard lock(mutex);
      held.push_back(unit);
      return false;
    };
    worker = std::make_unique<ScriptedWorker>(world.address, script);
    ASSERT_TRUE(eventually([&] {
      const std::lock_guard lock(mutex);
      return !held.empty() && world.get(job).job().leased() == held.size();
    }));
  }
  void TearDown() override { worker.reset(); }

  /// Gives back a unit that it has, after so many that it has not.
  void give_back(int before) const {
    v1::WorkerMessage message;
    v1::LeasedUnit invented = held.front();
    invented.mutable_lease()->set_number(999'999);
    for (int i = 0; i < before; ++i) *message.mutable_returned()->add_units() = invented;
    *message.mutable_returned()->add_units() = held.front();
    worker->write(message);
  }

  FarmWorld world;
  uint64_t job = 0;
  std::mutex mutex;
  std::vector<v1::LeasedUnit> held;
  std::unique_ptr<ScriptedWorker> worker;
};

// Each entry is looked up while all others wait.
TEST_F(LongMessages, AreNotReadBeyondWhatTheWorkerMayHave) {
  const size_t before = world.get(job).job().leased();
  give_back(20'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(world.get(job).job().leased(), before);
  give_back(50);
  EXPECT_TRUE(eventually([&] { return world.get(job).job().leased() < before; }));
}

}  // namespace
}  // namespace hyades::coordinator
