#pragma once

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {

inline constexpr WorkerId kCora{3};
inline constexpr WorkerId kDora{4};
inline constexpr WorkerId kEmil{5};

/// A frame of two tiles of which Anna has rendered the first, and Bert the first too, otherwise.
class Conflicts : public testing::Test {
 protected:
  void SetUp() override {
    b.join(kAnna);
    b.join(kBert);
    JobPlan plan = small_plan({1}, 1);
    plan_it(plan);
    b.add(plan);
    b.tell(FrameOpened{kJob, 1});
    anna_ = b.ask(kAnna);
    deliver_durably(anna_, 1);
    b.deliver(by(kBert), 0, 2);
    EXPECT_EQ(b.only<Conflict>().first, kAnna);
    EXPECT_EQ(b.only<Conflict>().second, kBert);
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
    EXPECT_TRUE(b.all<Quarantine>().empty());
    b.tell(Persisted{b.only<Persist>().id});
    b.deliver(by(kBert), 0, 2);  // again
    EXPECT_TRUE(b.all<Conflict>().empty());
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::conflict);
  }

  virtual void plan_it(JobPlan& /*plan*/) {}

  Lease by(WorkerId worker) const {
    Lease lease = anna_;
    lease.worker = worker;
    return lease;
  }
  void deliver_durably(const Lease& lease, uint8_t bits) {
    b.deliver(lease, 0, bits);
    b.tell(Persisted{b.only<Persist>().id});
  }

  /// What a worker is found divergent for has followed, and is durable.
  void divergence_is_stored() {
    const Persist divergent = b.all<Persist>().back();
    ASSERT_TRUE(std::holds_alternative<DivergentWorkerRecord>(divergent.record));
    b.tell(Persisted{divergent.id});
  }

  SchedulerBench b;
  Lease anna_;
};

}  // namespace hyades::coordinator
