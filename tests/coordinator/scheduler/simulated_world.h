#pragma once

#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduler.h"
#include "core/base/hash.h"
#include "tests/coordinator/scheduler/simulated_types.h"

namespace hyades::coordinator {

/// A small farm in which everything goes wrong: the real scheduler under a simulated network, clock
/// and store, driven by one seed. Messages are delayed, reordered, doubled and dropped; workers die
/// or lose the connection; the coordinator dies and comes back with what its store holds; the store
/// refuses; some workers' films are wrong; units and finishing fail; jobs are paused and cancelled;
/// the clock jumps. After a while the faults end, and then every job must end too. Throws a
/// std::string with what went wrong.
class SimulatedWorld {
 public:
  explicit SimulatedWorld(uint64_t seed) : random_(seed) {
    options_.lease_time = std::chrono::seconds(5);
    options_.copy_after = chance(0.5) ? Duration{0} : std::chrono::milliseconds(number(500, 4000));
    options_.unit_time = std::chrono::milliseconds(number(1, 3000));
    options_.class_patience = chance(0.5) ? Duration{0} : std::chrono::seconds(number(1, 10));
    fault_rate_ = chance(0.15) ? 0 : 0.15 * uniform();
    faults_end_ = TimePoint(std::chrono::seconds(number(5, 60)));
    const int classes = number(1, 2);
    const auto workers = static_cast<size_t>(number(classes, 7));
    for (size_t i = 0; i < workers; ++i) {
      SimWorker& w = workers_.emplace_back();
      w.name = "class " + std::to_string(i % static_cast<size_t>(classes));
      w.threads = number(1, 3);
      w.slowness = chance(0.1) ? 20 : 0.2 + 2 * uniform();
    }
    // Where two agree against one, the wrong one is found out: there must be enough of a class.
    if (classes == 1 && workers > 2 && chance(0.5)) {
      for (size_t i = 0; i < (workers > 4 ? 2U : 1U); ++i) workers_[i].corrupt = true;
      corrupt_ = true;
      if (chance(0.7)) options_.copy_after = std::chrono::milliseconds(number(20, 500));
    }
    const int jobs = number(1, 3);
    for (int i = 1; i <= jobs; ++i) make_job(JobId{static_cast<uint64_t>(i)});
  }

  /// Lives until all jobs have ended.
  void run() {
    start_coordinator();
    for (size_t i = 0; i < workers_.size(); ++i) after(delay(), [this, i] { connect(i); });
    after(delay(), [this] { nature(); });
    uint64_t steps = 0;
    while (!all_ended()) {
      if (events_.empty()) fail("nothing happens any more, and jobs are left");
      if (++steps > 300'000) fail("the jobs do not end");
      const Happening next = events_.top();
      events_.pop();
      now_ = std::max(now_, next.when);
      next.what();
    }
    check_audit();
  }

  // What was seen, for the test's own accounts.
  uint64_t restarts = 0;
  uint64_t kills = 0;
  uint64_t frames_done = 0;
  uint64_t frames_failed = 0;
  uint64_t duplicates = 0;
  uint64_t adopted = 0;
  uint64_t copies_revoked = 0;
  uint64_t overlaps = 0;
  uint64_t frames_restarted = 0;
  uint64_t conflicts = 0;
  uint64_t quarantines = 0;
  uint64_t tiles_voided = 0;
  uint64_t frames_reopened = 0;
  uint64_t frames_wrong = 0;  ///< finished before anybody compared

 private:
  [[noreturn]] static void fail(const std::string& what) { throw what; }
  bool chance(double p) { return uniform() < p; }
  bool fault() { return now_ < faults_end_ && chance(fault_rate_); }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  int number(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  Duration delay() { return std::chrono::microseconds(number(100, fault() ? 4'000'000 : 50'000)); }
  void after(Duration d, std::function<void()> what) {
    events_.push({now_ + d, ++serial_, std::move(what)});
  }

  void make_job(JobId id) {
    SimJob& job = jobs_[id];
    JobPlan& plan = job.plan;
    const bool long_one = chance(0.1);
    const int frames = long_one ? 1 : number(1, 4);
    for (int f = 1; f <= frames; ++f) plan.frames.push_back(f * 3);
    plan.region = {number(-5, 5), number(0, 5), number(6, 18), number(6, 18)};
    plan.tile_size = number(4, 9);
    plan.batches = static_cast<uint32_t>(long_one ? number(60, 140) : number(1, 9));
    plan.priority = number(0, 2);
    plan.owner = chance(0.5) ? "eve" : "fay";
    plan.frames_in_flight = static_cast<uint32_t>(number(1, 3));
    plan.max_workers = chance(0.3) ? static_cast<uint32_t>(number(1, 3)) : 0;
    plan.shuffle = static_cast<uint64_t>(number(0, 1));
    for (const int32_t f : plan.frames) {
      SimFrame& frame = job.frames[f];
      frame.poisoned = chance(0.05);
      frame.refused = chance(0.03);
      frame.unfinishable = chance(0.03);
    }
  }

  static uint64_t value_of(int32_t frame, const core::PixelRect& tile, uint32_t batch) {
    uint64_t h = core::hash_combine(static_cast<uint64_t>(frame), batch);
    h = core::hash_combine(h, static_cast<uint64_t>(tile.x0) << 32U | uint32_t(tile.y0));
    return core::hash_combine(h, static_cast<uint64_t>(tile.x1) << 32U | uint32_t(tile.y1));
  }
  static UnitName name(const core::Unit& u) {
    return {u.frame, u.tile.x0, u.tile.y0, u.batches.first, u.batches.count};
  }

  // The coordinator: the scheduler and what stands around it.

  void start_coordinator() {
    ++options_.incarnation;
    scheduler_ = std::make_unique<Scheduler>(options_);
    woken_ = false;
    records_.clear();
    for (auto& [id, job] : jobs_) {
      if (job.ended) continue;
      for (auto& [number, frame] : job.frames) {
        frame.batches.clear();
        frame.sum = 0;
        frame.over = false;
      }
      for (const int32_t f : job.stored.finished) job.frames[f].over = true;
      for (const FailedFrame& f : job.stored.failed) job.frames[f.frame].over = true;
      for (const AcceptedUnit& a : job.stored.accepted) add_to_film(job, a, 0);
      tell(JobAdded{id, job.plan, job.stored});
      if (job.paused) tell(JobPaused{id});
    }
  }

  void crash_coordinator() {
    ++restarts;
    scheduler_.reset();
    ++generation_;
    storing_.clear();
    unsettled_.clear();
    for (SimWorker& w : workers_) w.connected = false;
    after(std::chrono::milliseconds(number(1, 5000)), [this] {
      start_coordinator();
      for (size_t i = 0; i < workers_.size(); ++i) {
        if (!workers_[i].connected) after(delay(), [this, i] { connect(i); });
      }
    });
  }

  void tell(const Event& event) {
    if (!scheduler_) return;
    if (const auto* result = std::get_if<ResultArrived>(&event); result && refused(*result)) return;
    for (const Action& action : scheduler_->handle(event, now_)) {
      std::visit([this](const auto& a) { act(a); }, action);
    }
    if (chance(0.02)) check_audit();
    if (const auto wake = scheduler_->next_wake(); wake && !woken_) {
      woken_ = true;
      after(std::max(*wake - now_, Duration{std::chrono::milliseconds(1)}),
            [this, g = generation_] {
              if (g != generation_) return;
              woken_ = false;
              tell(Tick{});
            });
    }
  }

  /// Whether the coordinator takes nothing from the worker, because one before it had found it out.
  bool refused(const ResultArrived& result) {
    const uint64_t by = workers_[index_of(result.worker)].quarantined_by;
    if (by == 0 || by == generation_ + 1) return false;
    send(result.worker, [this, result](SimWorker& w) { drop(w, result.job, result.unit, {}); });
    tell(UnitReturned{result.worker, result.lease, result.job, result.unit});
    return true;
  }

  void tell_later(const Event& event) {
    after(delay(), [this, event, g = generation_] {
      if (g == generation_) tell(event);
    });
  }

  void check_audit() {
    if (!scheduler_) return;
    if (const std::string wrong = scheduler_->audit(); !wrong.empty()) fail("audit: " + wrong);
  }

  SimFrame& frame_of(JobId job, int32_t frame) { return jobs_.at(job).frames.at(frame); }

  void add_to_film(SimJob& job, const AcceptedUnit& accepted, uint64_t generation) {
    const core::Unit& unit = accepted.unit;
    SimFrame& frame = job.frames.at(unit.frame);
    const uint8_t by = accepted.digest[1];
    for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
      const SimBatch batch{value_of(unit.frame, unit.tile, b) + by, by, generation};
      if (!frame.batches.insert({{unit.tile.x0, unit.tile.y0, b}, batch}).second) {
        fail("a batch is counted twice");
      }
      frame.sum += batch.value;
    }
  }

  void act(const OpenFrame& a) {
    if (frame_of(a.job, a.frame).over) fail("a frame that is over is opened");
    if (frame_of(a.job, a.frame).refused) {
      tell_later(FrameRefused{a.job, a.frame, "refused"});
    } else {
      tell_later(FrameOpened{a.job, a.frame});
    }
  }

  void act(const Persist& a) {
    if (const auto* unit = std::get_if<UnitRecord>(&a.record)) {
      records_[a.id] = unit->accepted;
      unsettled_.insert({unit->job, a.id});
    }
    ++storing_[frame_of(a.record)];
    store_later(a);
  }

  static std::pair<JobId, int32_t> frame_of(const Record& record) {
    if (const auto* unit = std::get_if<UnitRecord>(&record)) {
      return {unit->job, unit->accepted.unit.frame};
    }
    if (const auto* failed = std::get_if<FrameFailedRecord>(&record)) {
      return {failed->job, failed->failed.frame};
    }
    if (const auto* done = std::get_if<FrameFinishedRecord>(&record)) {
      return {done->job, done->frame};
    }
    if (const auto* voided = std::get_if<TileVoidedRecord>(&record)) {
      return {voided->job, voided->frame};
    }
    const auto& again = std::get<FrameRestartedRecord>(record);
    return {again.job, again.frame};
  }

  void store_later(const Persist& a) {
    const bool refuse = fault();
    after(delay(), [this, a, refuse, g = generation_] {
      if (g != generation_) return;  // it died before the bytes were on the disk
      // A job's log keeps order; it matters only where earlier records become void.
      if (std::holds_alternative<FrameRestartedRecord>(a.record) &&
          storing_[frame_of(a.record)] > 1) {
        return store_later(a);
      }
      if (const auto* voided = std::get_if<TileVoidedRecord>(&a.record);
          voided && stores_unit_of(*voided)) {
        return store_later(a);
      }
      if (!refuse) store(a.record);
      // Durable now; but nobody hears of it if the coordinator dies before the next line runs.
      after(delay(), [this, a, refuse, g] {
        if (g != generation_) return;
        --storing_[frame_of(a.record)];
        unsettled_.erase({frame_of(a.record).first, a.id});
        if (refuse) {
          tell(PersistFailed{a.id, "disk full"});
        } else {
          tell(Persisted{a.id});
        }
      });
    });
  }

  /// Whether a film of the tile is still on its way to the disk, or was said to be and nobody knows
  /// yet that it has arrived.
  bool stores_unit_of(const TileVoidedRecord& voided) const {
    for (const auto& [id, accepted] : records_) {
      if (accepted.unit.frame == voided.frame && accepted.unit.tile == voided.tile &&
          unsettled_.contains({voided.job, id})) {
        return true;
      }
    }
    return false;
  }

  void store(const Record& record) {
    if (const auto* unit = std::get_if<UnitRecord>(&record)) {
      SimJob& job = jobs_.at(unit->job);
      job.stored.accepted.push_back(unit->accepted);
      if (!job.stored_units.insert(name(unit->accepted.unit)).second)
        fail("a unit is stored twice");
    } else if (const auto* done = std::get_if<FrameFinishedRecord>(&record)) {
      jobs_.at(done->job).stored.finished.push_back(done->frame);
    } else if (const auto* failed = std::get_if<FrameFailedRecord>(&record)) {
      jobs_.at(failed->job).stored.failed.push_back(failed->failed);
    } else if (const auto* voided = std::get_if<TileVoidedRecord>(&record)) {
      SimJob& job = jobs_.at(voided->job);
      std::erase_if(job.stored.accepted, [&](const AcceptedUnit& u) {
        const bool there = u.unit.frame == voided->frame && u.unit.tile == voided->tile;
        if (there) job.stored_units.erase(name(u.unit));
        return there;
      });
    } else {
      const auto& again = std::get<FrameRestartedRecord>(record);
      SimJob& job = jobs_.at(again.job);
      std::erase_if(job.stored.failed,
                    [&](const FailedFrame& f) { return f.frame == again.frame; });
      std::erase_if(job.stored.accepted,
                    [&](const AcceptedUnit& u) { return u.unit.frame == again.frame; });
      std::erase_if(job.stored_units,
                    [&](const UnitName& u) { return std::get<0>(u) == again.frame; });
    }
  }

  bool is_stored(JobId job, const core::Unit& unit) {
    return jobs_.at(job).stored_units.contains(name(unit));
  }

  void act(const Merge& a) {
    if (!is_stored(a.job, a.unit)) fail("a film is merged that is not durable");
    if (frame_of(a.job, a.unit.frame).over) fail("a film is merged into a frame that is over");
    add_to_film(jobs_.at(a.job), records_.at(a.record), generation_ + 1);
  }

  void act(const FinishFrame& a) {
    SimJob& job = jobs_.at(a.job);
    SimFrame& frame = job.frames.at(a.frame);
    const TileGrid grid(job.plan.region, job.plan.tile_size);
    uint64_t oracle = 0;
    for (uint32_t t = 0; t < grid.size(); ++t) {
      for (uint32_t b = 0; b < job.plan.batches; ++b) {
        oracle += value_of(a.frame, grid.tile(t), b);
      }
    }
    bool wrong = false;
    for (const auto& [place, batch] : frame.batches) {
      if (batch.corrupted_by == 0) continue;
      wrong = true;
      // It may never have been compared, or the coordinator that knew whose it was has died.
      const uint64_t found_out_by = workers_[batch.corrupted_by - 1U].quarantined_by;
      if (found_out_by != 0 && batch.generation == found_out_by) {
        fail("a film is finished with what a worker did that had been found out");
      }
    }
    frames_wrong += wrong;
    if (!wrong && frame.sum != oracle) fail("a film is finished that is not the frame's");
    if (frame.unfinishable || fault()) {
      tell_later(FinishFailed{a.job, a.frame, "no room for a picture"});
    } else {
      tell_later(FinishDone{a.job, a.frame});
    }
  }

  void act(const FrameDone& a) {
    ++frames_done;
    SimFrame& frame = frame_of(a.job, a.frame);
    if (frame.over) fail("a frame is over twice");
    if (frame.poisoned || frame.refused || frame.unfinishable) fail("a hopeless frame is done");
    frame.over = true;
  }

  void act(const FrameFailed& a) {
    ++frames_failed;
    SimFrame& frame = frame_of(a.job, a.frame);
    if (frame.over) fail("a frame is over twice");
    if (!frame.poisoned && !frame.refused && !frame.unfinishable &&
        a.reason != "no room for a picture") {
      fail("a good frame failed: " + a.reason);
    }
    frame.over = true;
  }

  void act(const FrameRestarted& a) {
    ++frames_restarted;
    SimFrame& frame = frame_of(a.job, a.frame);
    frame.batches.clear();
    frame.sum = 0;
    frame.over = false;
  }

  void act(const JobEnded& a) {
    SimJob& job = jobs_.at(a.job);
    if (job.ended) fail("a job ends twice");
    if (a.cancelled != job.cancelled) fail("a job is cancelled that nobody cancelled");
    if (!a.cancelled && a.done + a.failed != job.plan.frames.size()) fail("frames are missing");
    job.ended = true;
  }

  void act(const Conflict&) {
    ++conflicts;
    if (!corrupt_) fail("a conflict between equal films");
  }
  void act(const Quarantine& a) {
    ++quarantines;
    SimWorker& w = workers_[index_of(a.worker)];
    if (!w.corrupt) fail("a good worker is quarantined");
    w.quarantined_by = generation_ + 1;
  }
  void act(const TileVoided& a) {
    ++tiles_voided;
    SimFrame& frame = frame_of(a.job, a.frame);
    if (frame.over) fail("a tile of a frame that is over is voided");
    std::erase_if(frame.batches, [&](const auto& entry) {
      const auto& [place, batch] = entry;
      if (std::get<0>(place) != a.tile.x0 || std::get<1>(place) != a.tile.y0) return false;
      frame.sum -= batch.value;
      return true;
    });
  }
  void act(const FrameReopened&) { ++frames_reopened; }

  // What goes to workers.
  void act(const Lease& a) {
    if (a.adopted) ++adopted;
    send(a.worker, [this, a](SimWorker& w) {
      if (a.adopted) {
        for (auto& [order, held] : w.held) {
          if (held.job == a.job && held.unit == a.units.front()) held.lease = a.lease;
        }
        return;
      }
      for (const core::Unit& unit : a.units) take(w, {a.job, unit, a.lease, false});
      w.asked = std::max(0, w.asked - static_cast<int>(a.units.size()));
    });
  }
  void act(const Revoke& a) {
    ++copies_revoked;
    send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, a.lease); });
  }
  void act(const Acknowledge& a) {
    if (!is_stored(a.job, a.unit) && !jobs_.at(a.job).ended) {
      fail("acknowledged before it was durable");
    }
    send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, {}); });
  }
  void act(const Reject& a) {
    if (a.reason == RejectReason::malformed) fail("a good unit is malformed");
    overlaps += a.reason == RejectReason::overlap;
    if (a.reason == RejectReason::not_now) return;
    send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, {}); });
  }

  // Workers and the network.

  // The scheduler's number 0 is nobody's.
  static WorkerId id_of(size_t i) { return WorkerId{i + 1}; }
  static size_t index_of(WorkerId id) { return static_cast<size_t>(id) - 1; }

  template <class Do>
  void send(WorkerId id, Do what) {
    const size_t i = index_of(id);
    const int times = fault() ? number(0, 2) : 1;
    for (int t = 0; t < times; ++t) {
      after(delay(), [this, i, what, s = workers_[i].session] {
        SimWorker& w = workers_[i];
        if (w.session != s || !w.connected) return;
        what(w);
        ask(i);
      });
    }
  }

  void send_up(size_t i, const Event& event) {
    if (!workers_[i].connected) return;
    const int times = fault() ? number(0, 2) : 1;
    duplicates += times > 1;
    for (int t = 0; t < times; ++t) tell_later(event);
  }

  void connect(size_t i) {
    SimWorker& w = workers_[i];
    if (!scheduler_ || w.connected) return;
    w.connected = true;
    ++w.session;
    w.asked = 0;
    WorkerJoined hello{id_of(i), static_cast<uint32_t>(w.threads), w.name, {}};
    for (const auto& [order, held] : w.held) {
      hello.in_hand.push_back({held.lease, held.job, held.unit});
    }
    tell(hello);
    if (w.quarantined_by != 0) tell(WorkerBarred{id_of(i), true});
    ask(i);
    heartbeat(i, w.session);
  }

  void heartbeat(size_t i, uint64_t session) {
    SimWorker& w = workers_[i];
    if (!w.connected || w.session != session) return;
    WorkerAlive alive{id_of(i), {}};
    for (const auto& [order, held] : w.held) alive.leases.push_back(held.lease);
    send_up(i, alive);
    for (const auto& [order, held] : w.held) {
      if (held.rendered) deliver(i, held);
    }
    w.asked = 0;  // what was asked may be lost
    ask(i);
    after(std::chrono::milliseconds(1500), [this, i, session] { heartbeat(i, session); });
  }

  void ask(size_t i) {
    SimWorker& w = workers_[i];
    int busy = 0;
    for (const auto& [order, held] : w.held) busy += !held.rendered;
    const int more = 2 * w.threads - busy - w.asked;
    if (more <= 0) return;
    w.asked += more;
    send_up(i, WorkRequested{id_of(i), static_cast<uint32_t>(more)});
  }

  void take(SimWorker& w, const UnitHeld& unit) {
    const uint64_t order = ++serial_;
    w.held.emplace(order, unit);
    const double work = unit.unit.batches.count * (0.5 + uniform()) * w.slowness * 0.05;
    const auto i = static_cast<size_t>(&w - workers_.data());
    after(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(work)),
          [this, i, order, life = w.life] {
            if (workers_[i].life == life) rendered(i, order);
          });
  }

  void rendered(size_t i, uint64_t order) {
    SimWorker& w = workers_[i];
    const auto it = w.held.find(order);
    if (it == w.held.end()) return;
    UnitHeld& held = it->second;
    SimFrame& frame = frame_of(held.job, held.unit.frame);
    const bool poisoned = frame.poisoned && held.unit.tile.x0 == jobs_[held.job].plan.region.x0 &&
                          held.unit.tile.y0 == jobs_[held.job].plan.region.y0;
    if (poisoned || (frame.bad_luck > 0 && fault())) {
      if (!poisoned) --frame.bad_luck;
      send_up(i, UnitFailed{id_of(i), held.lease, held.job, held.unit, "it hurt"});
      w.held.erase(it);
    } else if (fault() && held.unit.batches.count > 1) {
      // It drains: half of the batches, the rest goes back.
      UnitHeld half = held;
      half.unit.batches.count /= 2;
      half.rendered = true;
      w.held.erase(it);
      deliver(i, half);
      w.held.emplace(order, half);
    } else if (fault()) {
      send_up(i, UnitReturned{id_of(i), held.lease, held.job, held.unit});
      w.held.erase(it);
    } else {
      held.rendered = true;
      deliver(i, held);
    }
    ask(i);
  }

  void deliver(size_t i, const UnitHeld& held) {
    Digest digest{};
    digest[0] = static_cast<uint8_t>(held.unit.frame);
    if (workers_[i].corrupt) digest[1] = static_cast<uint8_t>(i + 1);
    send_up(i, ResultArrived{id_of(i), held.lease, held.job, held.unit, digest,
                             std::chrono::milliseconds(50) * held.unit.batches.count});
  }

  static void drop(SimWorker& w, JobId job, const core::Unit& unit, const LeaseId& lease) {
    std::erase_if(w.held, [&](const auto& entry) {
      const UnitHeld& held = entry.second;
      return held.job == job && held.unit == unit && (lease == LeaseId{} || held.lease == lease);
    });
  }

  /// Deaths, cuts, and people at the controls.
  void nature() {
    if (now_ >= faults_end_) {
      for (auto& [id, job] : jobs_) {
        if (std::exchange(job.paused, false)) tell(JobResumed{id});
      }
      if (!scheduler_) return after(std::chrono::seconds(1), [this] { nature(); });
      for (size_t i = 0; i < workers_.size(); ++i) connect(i);
      return;
    }
    const auto i = static_cast<size_t>(number(0, static_cast<int>(workers_.size()) - 1));
    SimWorker& w = workers_[i];
    const auto job = std::next(jobs_.begin(), number(0, static_cast<int>(jobs_.size()) - 1));
    if (chance(2 * fault_rate_) && w.connected) {
      w.connected = false;
      ++w.session;
      if (chance(0.5)) {
        ++kills;
        ++w.life;
        w.held.clear();
        // It comes back with another build.
        if (options_.class_patience > Duration{0} && !corrupt_ && chance(0.3)) w.name += "'";
      }
      // The coordinator notices now, later, or not before it is back.
      const uint64_t session = w.session;
      after(delay(), [this, i, session] {
        if (workers_[i].session == session) tell(WorkerLost{id_of(i)});
      });
      after(std::chrono::milliseconds(number(10, 8000)), [this, i] { connect(i); });
    }
    if (chance(fault_rate_ / 4) && scheduler_) crash_coordinator();
    if (chance(fault_rate_ / 4)) now_ += std::chrono::seconds(number(1, 100));
    if (chance(fault_rate_ / 2) && !job->second.ended) {
      job->second.paused = !job->second.paused;
      if (job->second.paused) {
        tell(JobPaused{job->first});
      } else {
        tell(JobResumed{job->first});
      }
    }
    if (chance(fault_rate_ / 4) && !job->second.ended) {
      tell(JobReprioritised{job->first, job->second.plan.priority = number(0, 2)});
    }
    if (chance(fault_rate_ / 8) && !job->second.ended) tell(FramesRetried{job->first});
    if (chance(fault_rate_ / 2)) {
      tell(WorkerBarred{id_of(i), true});
      after(std::chrono::milliseconds(number(10, 20000)), [this, i] {
        if (workers_[i].quarantined_by == 0) tell(WorkerBarred{id_of(i), false});
      });
    }
    if (chance(fault_rate_ / 20) && !job->second.ended && scheduler_) {
      job->second.cancelled = true;
      tell(JobCancelled{job->first});
    }
    after(std::chrono::milliseconds(number(10, 1000)), [this] { nature(); });
  }

  bool all_ended() const {
    for (const auto& [id, job] : jobs_) {
      if (!job.ended) return false;
    }
    return true;
  }

  std::mt19937_64 random_;
  SchedulerOptions options_;
  double fault_rate_ = 0;
  TimePoint faults_end_;
  TimePoint now_;
  uint64_t serial_ = 0;
  uint64_t generation_ = 0;  ///< of coordinators
  bool corrupt_ = false;     ///< some workers' films are wrong
  bool woken_ = false;       ///< a Tick is on its way
  std::priority_queue<Happening> events_;
  std::unique_ptr<Scheduler> scheduler_;
  std::vector<SimWorker> workers_;
  std::map<JobId, SimJob> jobs_;
  std::map<std::pair<JobId, int32_t>, int> storing_;  ///< records on their way to the disk
  std::map<RecordId, AcceptedUnit> records_;          ///< of this coordinator
  std::set<std::pair<JobId, RecordId>> unsettled_;    ///< films on their way to the disk
};

}  // namespace hyades::coordinator
