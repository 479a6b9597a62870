// The scheduler alone: 10,000 workers and 1,000 jobs, everybody asks, delivers and asks again. A
// decision is one event answered: a lease granted, a result judged, a record acknowledged.
#include <benchmark/benchmark.h>

#include <deque>
#include <random>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

class Farm {
 public:
  Farm(int workers, int jobs, int units_per_lease)
      : scheduler_(options()), units_(static_cast<uint32_t>(units_per_lease)) {
    for (int j = 1; j <= jobs; ++j) add_job();
    for (int w = 0; w < workers; ++w) {
      tell(WorkerJoined{WorkerId{static_cast<uint64_t>(w)}, 8, "class", {}});
      tell(WorkRequested{WorkerId{static_cast<uint64_t>(w)}, units_});
    }
  }

  /// One worker delivers a unit and, with its lease's last, asks for the next. Returns how many
  /// of its wishes and results were answered; what the coordinator echoes of actions is not
  /// counted.
  uint64_t step() {
    const uint64_t before = answered_;
    now_ += std::chrono::microseconds(5);
    // Units come back in about the order in which they went out.
    const size_t pick = random_() % std::min<size_t>(out_.size(), 1000);
    std::swap(out_[pick], out_.front());
    Lease lease = std::move(out_.front());
    out_.pop_front();
    const core::Unit unit = lease.units.back();
    lease.units.pop_back();
    tell(ResultArrived{lease.worker, lease.lease, lease.job, unit, Digest{},
                       std::chrono::milliseconds(500) * unit.batches.count});
    if (lease.units.empty()) {
      tell(WorkRequested{lease.worker, units_});
    } else {
      out_.push_front(std::move(lease));
    }
    return answered_ - before;
  }

 private:
  static SchedulerOptions options() {
    SchedulerOptions o;
    o.unit_time = std::chrono::seconds(5);
    return o;
  }

  void add_job() {
    const uint64_t id = next_job_++;
    JobPlan plan;
    for (int f = 1; f <= 10; ++f) plan.frames.push_back(f);
    plan.region = {0, 0, 960, 540};
    plan.batches = 64;
    plan.priority = static_cast<int>(id % 3);
    plan.owner = "owner " + std::to_string(id % 50);
    tell(JobAdded{JobId{id}, plan, {}});
  }

  void tell(const Event& event) {
    ++answered_;
    std::deque<Event> events{event};
    while (!events.empty()) {
      for (Action& action : scheduler_.handle(events.front(), now_)) {
        if (auto* lease = std::get_if<Lease>(&action)) {
          out_.push_back(std::move(*lease));
        } else if (const auto* persist = std::get_if<Persist>(&action)) {
          events.emplace_back(Persisted{persist->id});
        } else if (const auto* open = std::get_if<OpenFrame>(&action)) {
          events.emplace_back(FrameOpened{open->job, open->frame});
        } else if (const auto* finish = std::get_if<FinishFrame>(&action)) {
          events.emplace_back(FinishDone{finish->job, finish->frame});
        } else if (std::holds_alternative<JobEnded>(action)) {
          add_job();
        }
      }
      events.pop_front();
    }
  }

  Scheduler scheduler_;
  const uint32_t units_;
  TimePoint now_;
  uint64_t next_job_ = 1;
  uint64_t answered_ = 0;
  std::deque<Lease> out_;
  std::mt19937_64 random_{7};
};

void decisions(benchmark::State& state) {
  Farm farm(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
            static_cast<int>(state.range(2)));
  uint64_t events = 0;
  uint64_t units = 0;
  for (auto _ : state) {
    events += farm.step();
    ++units;
  }
  state.counters["decisions/s"] =
      benchmark::Counter(static_cast<double>(events), benchmark::Counter::kIsRate);
  state.counters["units/s"] =
      benchmark::Counter(static_cast<double>(units), benchmark::Counter::kIsRate);
}
BENCHMARK(decisions)
    ->ArgNames({"workers", "jobs", "units_per_lease"})
    ->Args({2, 1, 1})
    ->Args({100, 10, 8})
    ->Args({10'000, 1'000, 1})
    ->Args({10'000, 1'000, 16})
    ->MinTime(1.0);

}  // namespace
}  // namespace hyades::coordinator

BENCHMARK_MAIN();
