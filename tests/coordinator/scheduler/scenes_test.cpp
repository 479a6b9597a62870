// Workers spread over the frames in flight where loading a scene costs more than it brings.
#include <map>
#include <set>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr WorkerId kCleo{3};

/// Frames of 20 batches of a second each, one unit each.
JobPlan frames(std::vector<int32_t> numbers) {
  JobPlan plan = small_plan(std::move(numbers), 10);
  return plan;
}

SchedulerOptions one_batch_each() {
  SchedulerOptions options;
  options.unit_time = seconds(1);
  return options;
}

void deliver_after(Bench& b, const Lease& lease, Duration since_lease, Duration rendered) {
  b.now += since_lease;
  b.tell(ResultArrived{lease.worker, lease.lease, lease.job, lease.units[0], digest(1), rendered});
  b.tell(Persisted{b.only<Persist>().id});
}

/// Anna has rendered a unit of frame 1: loading took five seconds, a batch takes one.
void learn(Bench& b, const std::vector<int32_t>& numbers, uint32_t in_flight = 3) {
  b.join(kAnna);
  JobPlan plan = frames(numbers);
  plan.frames_in_flight = in_flight;
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  deliver_after(b, b.ask(kAnna), seconds(6), seconds(1));
  for (size_t i = 1; i < std::min<size_t>(in_flight, numbers.size()); ++i) {
    b.tell(FrameOpened{kJob, numbers[i]});
  }
}

TEST(Scenes, AWorkerBeginsWithAFrameThatHasRoomForIt) {
  Bench b(one_batch_each(), seconds(3));
  learn(b, {1, 2, 3});
  EXPECT_EQ(b.ask(kAnna).units[0].frame, 1) << "she has it";
  b.join(kBert);
  EXPECT_EQ(b.ask(kBert).units[0].frame, 2) << "19 seconds are no work for two who load for five";
  b.join(kCleo);
  EXPECT_EQ(b.ask(kCleo).units[0].frame, 3);
}

TEST(Scenes, WhereScenesTakeNoTimeAllGoToTheFirstFrame) {
  Bench b(one_batch_each());
  learn(b, {1, 2, 3}, 1);
  b.join(kBert);
  EXPECT_EQ(b.ask(kAnna).units[0].frame, 1);
  EXPECT_EQ(b.ask(kBert).units[0].frame, 1);
}

TEST(Scenes, WhereEveryFrameHasWorkersEnoughTheyShareThem) {
  Bench b(one_batch_each(), seconds(3));
  learn(b, {1});
  b.join(kBert);
  EXPECT_EQ(b.ask(kBert).units[0].frame, 1);
}

TEST(Scenes, NobodyBeginsWithAFrameThatIsLeasedBeforeItsSceneIsThere) {
  SchedulerOptions options = one_batch_each();
  options.copy_after = {};
  Bench b(options, seconds(3));
  learn(b, {1});
  for (int i = 0; i < 14; ++i) deliver_after(b, b.ask(kAnna), seconds(1), seconds(1));
  b.join(kBert);
  b.tell(WorkRequested{kBert, 1});
  EXPECT_TRUE(b.all<Lease>().empty()) << "Anna needs five seconds for the rest, Bert to load";
  // But she does not come.
  const TimePoint before = b.now;
  bool got = false;
  for (int i = 0; i < 10 && !got; ++i) {
    ASSERT_TRUE(b.scheduler.next_wake()) << "Bert would wait for ever";
    b.now = std::max(b.now, *b.scheduler.next_wake());
    b.tell(Tick{});
    got = !b.all<Lease>().empty();
  }
  EXPECT_TRUE(got);
  EXPECT_LE(b.now, before + seconds(7));
}

TEST(Scenes, TheNextSceneIsLoadedWhileTheLastIsRendered) {
  Bench b(one_batch_each(), seconds(3));
  learn(b, {1, 2});
  std::vector<int32_t> order;
  while (order.empty() || order.back() == 1) {
    const Lease lease = b.ask(kAnna);
    order.push_back(lease.units[0].frame);
    if (order.back() == 1) deliver_after(b, lease, seconds(1), seconds(1));
  }
  // One unit of frame 2 is with her, and she goes on with frame 1.
  int more = 0;
  while (more < 20) {
    const Lease lease = b.ask(kAnna);
    if (lease.units[0].frame != 1) break;
    ++more;
    deliver_after(b, lease, milliseconds(1000), seconds(1));
  }
  EXPECT_GE(more, 5) << "as many seconds as the scene takes";
  EXPECT_EQ(order.size() + static_cast<size_t>(more), 20U) << "nothing of frame 1 is left behind";
}

}  // namespace
}  // namespace hyades::coordinator
