#include "tests/coordinator/scheduler/big_world.h"

#include <time.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "coordinator/scheduler/tile_grid.h"

namespace hyades::coordinator {
namespace {

constexpr double kHeartbeat = 5;
constexpr double kSync = 0.004;  ///< group commit of the film log
constexpr double kNoticed = 3;   ///< a worker that is gone is taken for lost
constexpr size_t kScenesKept = 3;
constexpr size_t kMoments = 20;
constexpr uint64_t kMeasureEvery = 16;  ///< events; asking for the time costs more than most

double cpu_now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

SchedulerOptions scheduler_options(const BigWorldOptions& options) {
  SchedulerOptions scheduler;
  scheduler.unit_time = options.unit_time;
  scheduler.lease_time = std::chrono::seconds(30);
  scheduler.copy_after = std::chrono::seconds(10);
  return scheduler;
}

Duration duration(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

void print(const char* name, const ThreadTime& time, double seconds) {
  const double percent = 100 / time.there;
  std::printf(
      "  %s, %.0f s: %.2f %% of the threads' time counts; %.2f %% lost, %.2f %% starting, %.2f %% "
      "loading scenes, %.2f %% without a unit\n",
      name, seconds, 100 * time.efficiency(), percent * time.lost, percent * time.starting,
      percent * time.loading, percent * time.starved);
}

}  // namespace

void print(const BigWorldReport& r) {
  ThreadTime all = r.enough;
  all.there += r.tail.there;
  all.rendering += r.tail.rendering;
  all.starting += r.tail.starting;
  all.loading += r.tail.loading;
  all.starved += r.tail.starved;
  all.lost += r.tail.lost;
  print("with enough work", r.enough, r.enough_until);
  print("tail", r.tail, r.duration - r.enough_until);
  print("all", all, r.duration);
  std::printf(
      "  %.0f units/s of %.2f s, %.0f scenes/s, %.1f pre-empted/min\n"
      "  %.0f events/s, %.2f us each: %.1f %% of a processor\n",
      static_cast<double>(r.units) / r.duration, all.rendering / static_cast<double>(r.units),
      static_cast<double>(r.scenes_loaded) / r.duration,
      static_cast<double>(r.preempted) / r.duration * 60,
      static_cast<double>(r.events) / r.duration,
      1e6 * r.cpu_seconds / static_cast<double>(r.events), 100 * r.cpu_seconds / r.duration);
  for (const Moment& m : r.end) {
    std::printf("  %6.0f s: %zu threads, %zu render, %zu wait for a scene, %zu for a unit\n", m.at,
                m.threads, m.rendering, m.loading, m.starved);
  }
}

BigWorld::BigWorld(const BigWorldOptions& options)
    : options_(options), random_(options.seed), scheduler_(scheduler_options(options)) {
  machines_.resize(options.workers);
}

BigWorldReport BigWorld::run() {
  for (size_t j = 1; j <= options_.jobs; ++j) {
    JobPlan plan;
    for (int f = 1; f <= options_.frames; ++f) plan.frames.push_back(f);
    plan.region = options_.region;
    plan.batches = options_.batches;
    plan.owner = "owner " + std::to_string(j % options_.owners);
    ++open_jobs_;
    const TileGrid grid(plan.region, plan.tile_size);
    for (uint32_t t = 0; t < grid.size(); ++t) {
      to_render_ += options_.frames * cost(JobId{j}, {1, grid.tile(t), {0, plan.batches}});
    }
    tell(JobAdded{JobId{j}, plan, {}});
  }
  for (size_t i = 0; i < machines_.size(); ++i) {
    after(uniform(), [this, i] { start(i); });
  }
  look_at_the_clock();
  while (open_jobs_ > 0) {
    if (events_.empty()) throw std::string("nothing happens any more, and jobs are left");
    const Happening next = events_.top();
    events_.pop();
    now_ = std::max(now_, next.when);
    next.what();
  }
  report_.duration = seconds_now();
  for (Machine& m : machines_) account(m);
  return report_;
}

/// Puts the time since the last call to what the machine's threads did; to be called before that
/// changes.
void BigWorld::account(Machine& m) {
  const double time = seconds_now() - std::exchange(m.since, seconds_now());
  if (!m.there || time <= 0) return;
  size_t busy = 0;
  for (const Unit& u : m.units) busy += u.began >= 0;
  const size_t idle = options_.threads - busy;
  const size_t loading = m.begun ? std::min(idle, m.units.size() - busy) : 0;
  phase_->there += time * options_.threads;
  phase_->rendering += time * static_cast<double>(busy);
  phase_->loading += time * static_cast<double>(loading);
  (m.begun ? phase_->starved : phase_->starting) += time * static_cast<double>(idle - loading);
}

void BigWorld::look_whether_enough() {
  const double unit = std::chrono::duration<double>(options_.unit_time).count();
  if (phase_ == &report_.tail || to_render_ >= 2 * unit * threads_there_) return;
  for (Machine& m : machines_) account(m);
  phase_ = &report_.tail;
  report_.enough_until = seconds_now();
}

/// Notes every second what the threads do.
void BigWorld::look_at_the_clock() {
  Moment moment{.at = seconds_now()};
  for (const Machine& m : machines_) {
    if (!m.there) continue;
    size_t busy = 0;
    for (const Unit& u : m.units) busy += u.began >= 0;
    const size_t idle = options_.threads - busy;
    const size_t loading = std::min(idle, m.units.size() - busy);
    moment.threads += options_.threads;
    moment.rendering += busy;
    moment.loading += loading;
    moment.starved += idle - loading;
  }
  report_.end.push_back(moment);
  if (report_.end.size() > kMoments) report_.end.pop_front();
  after(1, [this] { look_at_the_clock(); });
}

void BigWorld::after(double seconds, std::function<void()> what) {
  events_.push({now_ + duration(seconds), ++serial_, std::move(what)});
}

void BigWorld::tell(const Event& event) {
  const bool measured = ++report_.events % kMeasureEvery == 0;
  const double before = measured ? cpu_now() : 0;
  const std::vector<Action> actions = scheduler_.handle(event, now_);
  if (measured) report_.cpu_seconds += kMeasureEvery * (cpu_now() - before);
  for (const Action& action : actions) {
    std::visit([this](const auto& a) { act(a); }, action);
  }
  if (const auto wake = scheduler_.next_wake(); wake && !woken_) {
    woken_ = true;
    // The coordinator looks at its clock twenty times a second.
    const double until = std::chrono::duration<double>(*wake - now_).count();
    after(std::max(until, 0.05), [this] {
      woken_ = false;
      tell(Tick{});
    });
  }
}

// ---- workers ----

void BigWorld::start(size_t i) {
  Machine& m = machines_[i];
  m = Machine{.there = true,
              .life = m.life + 1,
              .id = WorkerId{next_worker_++},
              .speed = 0.6 + uniform(),
              .since = seconds_now()};
  threads_there_ += options_.threads;
  // From the same room to another continent.
  m.link = 0.0005 * std::exp(4.5 * uniform());
  machine_of_[m.id] = i;
  tell(WorkerJoined{m.id, options_.threads, "class", {}});
  ask(m, false);
  after(kHeartbeat * uniform(), [this, i, life = m.life] { beat(i, life); });
  if (options_.preempted_per_minute > 0) {
    after(-60 / options_.preempted_per_minute * std::log(1 - uniform()), [this, i, life = m.life] {
      if (machines_[i].life == life) leave(i);
    });
  }
}

/// Half of those that are pre-empted hear of it: they hand over what is done. Others are cut off.
void BigWorld::leave(size_t i) {
  Machine& m = machines_[i];
  account(m);
  threads_there_ -= options_.threads;
  ++report_.preempted;
  const bool told = uniform() < 0.5;
  if (told) tell(WorkerBarred{m.id, true});
  for (Unit& u : m.units) {
    const double done = u.began < 0 ? 0 : (seconds_now() - u.began) / u.seconds;
    Unit part = u;
    part.unit.batches.count = static_cast<uint32_t>(done * u.unit.batches.count);
    if (told && part.unit.batches.count > 0) {
      part.seconds = u.seconds * part.unit.batches.count / u.unit.batches.count;
      deliver(m, part, false);
      phase_->lost += done * u.seconds - part.seconds;
    } else {
      phase_->lost += done * u.seconds;
      if (told) tell(UnitReturned{m.id, u.lease, u.job, u.unit});
    }
  }
  const WorkerId id = m.id;
  after(told ? 1 : kNoticed, [this, id] {
    machine_of_.erase(id);
    tell(WorkerLost{id});
  });
  m.there = false;
  ++m.life;
  m.units.clear();
  after(30 + 90 * uniform(), [this, i] { start(i); });
}

void BigWorld::beat(size_t i, uint64_t life) {
  Machine& m = machines_[i];
  if (m.life != life) return;
  WorkerAlive alive{m.id, {}};
  for (const Unit& u : m.units) alive.leases.push_back(u.lease);
  after(m.link, [this, alive] { tell(alive); });
  after(kHeartbeat, [this, i, life] { beat(i, life); });
}

void BigWorld::ask(Machine& m, bool with_result) {
  const size_t enough = 2 * size_t{options_.threads};
  const size_t in_work = m.units.size() + m.asked;
  if (in_work >= enough) return;
  const auto more = static_cast<uint32_t>(enough - in_work);
  m.asked += more;
  // A result carries the wish: it arrives with it.
  const double delay = with_result ? m.link + 1e-9 : m.link;
  after(delay, [this, id = m.id, more] { tell(WorkRequested{id, more}); });
}

/// When the frame's scene is there; begins to load it where it is not.
double BigWorld::scene_at(Machine& m, JobId job, int32_t frame) {
  const std::pair scene{job, frame};
  const auto there = std::find_if(m.scenes.begin(), m.scenes.end(),
                                  [&](const auto& s) { return s.first == scene; });
  if (there != m.scenes.end()) {
    std::rotate(there, there + 1, m.scenes.end());
    return m.scenes.back().second;
  }
  // What is not needed goes, what was not used for longest first.
  for (auto s = m.scenes.begin(); s != m.scenes.end() && m.scenes.size() >= kScenesKept;) {
    const bool needed = std::any_of(m.units.begin(), m.units.end(), [&](const Unit& u) {
      return std::pair(u.job, u.unit.frame) == s->first;
    });
    s = needed ? s + 1 : m.scenes.erase(s);
  }
  ++report_.scenes_loaded;
  m.loads_until = std::max(m.loads_until, seconds_now()) + options_.scene_seconds / m.speed;
  m.scenes.emplace_back(scene, m.loads_until);
  return m.loads_until;
}

/// Gives free threads what waits.
void BigWorld::begin(size_t i) {
  Machine& m = machines_[i];
  account(m);
  size_t busy = 0;
  for (const Unit& u : m.units) busy += u.began >= 0;
  double soonest = 0;
  for (Unit& u : m.units) {
    if (busy == options_.threads) return;
    if (u.began >= 0) continue;
    const double ready = scene_at(m, u.job, u.unit.frame);
    if (ready > seconds_now()) {
      soonest = soonest == 0 ? ready : std::min(soonest, ready);
      continue;
    }
    ++busy;
    m.begun = true;
    u.began = seconds_now();
    after(u.seconds, [this, i, life = m.life, number = u.number] {
      if (machines_[i].life == life) done(i, number);
    });
  }
  if (soonest == 0 || m.looks_again) return;
  m.looks_again = true;
  const double wait = soonest - seconds_now() + 1e-6;
  after(wait, [this, i, life = m.life] {
    if (machines_[i].life != life) return;
    machines_[i].looks_again = false;
    begin(i);
  });
}

void BigWorld::done(size_t i, uint64_t number) {
  Machine& m = machines_[i];
  const auto found = std::find_if(m.units.begin(), m.units.end(),
                                  [&](const Unit& u) { return u.number == number; });
  if (found == m.units.end()) return;  // it was stopped
  const Unit unit = *found;
  account(m);
  m.units.erase(found);
  deliver(m, unit, true);
  begin(i);
}

void BigWorld::deliver(Machine& m, const Unit& unit, bool more) {
  ++report_.units;
  ResultArrived result{m.id, unit.lease, unit.job, unit.unit, Digest{}, duration(unit.seconds)};
  after(m.link, [this, result, seconds = unit.seconds] {
    arriving_ = seconds;
    tell(result);
    phase_->lost += std::exchange(arriving_, 0.0);  // nobody took it
  });
  if (more) ask(m, true);
}

/// Neighbouring tiles differ by factors, machines by themselves and from time to time.
double BigWorld::cost(JobId job, const core::Unit& unit) const {
  const uint64_t h =
      core::hash_combine(static_cast<uint64_t>(job), (static_cast<uint64_t>(unit.tile.x0) << 32U) |
                                                         static_cast<uint32_t>(unit.tile.y0));
  const double u = static_cast<double>(h >> 11U) * 0x1p-53;
  return options_.batch_seconds * (0.25 + 2.25 * u * u) * unit.batches.count;
}

// ---- what the coordinator wants done ----

template <class Message>
void BigWorld::send(WorkerId id, Message message) {
  const auto there = machine_of_.find(id);
  if (there == machine_of_.end()) return;
  const size_t i = there->second;
  after(machines_[i].link, [this, i, life = machines_[i].life, message = std::move(message)] {
    if (machines_[i].there && machines_[i].life == life) message(i);
  });
}

void BigWorld::act(const Lease& lease) {
  send(lease.worker, [this, lease](size_t i) {
    Machine& m = machines_[i];
    account(m);
    m.asked -= std::min(m.asked, static_cast<uint32_t>(lease.units.size()));
    for (const core::Unit& unit : lease.units) {
      const double seconds = cost(lease.job, unit) * (0.9 + 0.2 * uniform()) / m.speed;
      m.units.push_back({lease.job, lease.lease, unit, seconds, -1, ++serial_});
      scene_at(m, lease.job, unit.frame);
    }
    begin(i);
  });
}

void BigWorld::act(const Revoke& revoke) {
  send(revoke.worker, [this, revoke](size_t i) {
    Machine& m = machines_[i];
    account(m);
    std::erase_if(m.units, [&](const Unit& u) {
      const bool it = u.lease == revoke.lease && u.unit == revoke.unit;
      if (it && u.began >= 0) phase_->lost += seconds_now() - u.began;
      return it;
    });
    begin(i);
    ask(m, false);
  });
}

void BigWorld::act(const OpenFrame& open) { tell(FrameOpened{open.job, open.frame}); }

void BigWorld::act(const Persist& persist) {
  if (std::holds_alternative<UnitRecord>(persist.record)) {
    took_[persist.id] = std::exchange(arriving_, 0.0);
  }
  if (syncing_.empty()) {
    after(kSync, [this] {
      for (const RecordId id : std::exchange(syncing_, {})) tell(Persisted{id});
    });
  }
  syncing_.push_back(persist.id);
}

void BigWorld::act(const Merge& merge) {
  const core::Unit& unit = merge.unit;
  Film& film = films_[{merge.job, unit.frame}][{unit.tile.x0, unit.tile.y0}];
  film.resize((options_.batches + 63) / 64);
  for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
    const uint64_t bit = uint64_t{1} << (b % 64);
    if ((film[b / 64] & bit) != 0) throw std::string("a batch counts twice");
    film[b / 64] |= bit;
  }
  const auto took = took_.find(merge.record);
  report_.counted += took->second;
  took_.erase(took);
  to_render_ -= cost(merge.job, unit);
  look_whether_enough();
}

void BigWorld::act(const FinishFrame& finish) {
  uint64_t held = 0;
  const auto film = films_.find({finish.job, finish.frame});
  for (const auto& [tile, words] : film->second) {
    for (const uint64_t word : words) held += static_cast<uint64_t>(std::popcount(word));
  }
  const TileGrid grid(options_.region, JobPlan{}.tile_size);
  if (held != uint64_t{grid.size()} * options_.batches) {
    throw std::string("a frame is finished that is not complete");
  }
  films_.erase(film);
  after(1, [this, finish] { tell(FinishDone{finish.job, finish.frame}); });
}

void BigWorld::act(const JobEnded& /*ended*/) { --open_jobs_; }

}  // namespace hyades::coordinator
