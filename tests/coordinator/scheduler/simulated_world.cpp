// The farm as a whole: what it is made of, and its coordinator, who lives and dies.
#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

SimulatedWorld::SimulatedWorld(uint64_t seed, bool cramped) : random_(seed), cramped_(cramped) {
  options_.lease_time = std::chrono::seconds(5);
  options_.copy_after = chance(0.5) ? Duration{0} : std::chrono::milliseconds(number(500, 4000));
  options_.unit_time = std::chrono::milliseconds(number(1, 3000));
  options_.class_patience = chance(0.5) ? Duration{0} : std::chrono::seconds(number(1, 10));
  fault_rate_ = chance(0.15) ? 0 : 0.15 * uniform();
  faults_end_ = TimePoint(std::chrono::seconds(number(5, 60)));
  const int classes = number(1, 2);
  const auto workers = static_cast<size_t>(number(cramped_ ? 3 : classes, 7));
  for (size_t i = 0; i < workers; ++i) {
    SimWorker& w = workers_.emplace_back();
    w.name = "class " + std::to_string(i % static_cast<size_t>(classes));
    w.threads = number(1, 3);
    w.slowness = chance(0.1) ? 20 : 0.2 + 2 * uniform();
    if (cramped_) w.slowness *= 2;  // so that they live long enough
  }
  // Where two agree against one, the wrong one is found out: there must be enough of a class.
  if (classes == 1 && workers > 2 && chance(0.5)) {
    for (size_t i = 0; i < (workers > 4 ? 2U : 1U); ++i) workers_[i].corrupt = true;
    corrupt_ = true;
    if (chance(0.7)) options_.copy_after = std::chrono::milliseconds(number(20, 500));
  }
  if (!corrupt_ && workers > 2 && chance(0.2)) workers_[0].broken = broken_ = true;
  if (!corrupt_ && !broken_ && chance(0.4)) {
    choosy_ = true;
    for (size_t i = 0; i < workers; ++i) {
      SimWorker& w = workers_[i];
      // The first one may have everything.
      for (const char* tag : {"gpu", "quiet"}) {
        if (i == 0 || chance(0.5)) w.tags.emplace_back(tag);
      }
      if (i > 0 && chance(0.7)) w.memory = static_cast<uint64_t>(number(1, 9));
    }
  }
  options_.affinity_time = std::chrono::milliseconds(chance(0.5) ? 0 : number(1, 20'000));
  options_.scene_time = std::chrono::milliseconds(chance(0.5) ? 0 : number(1, 3000));
  real_store_ = chance(0.5);
  if (chance(0.4)) options_.film_memory = static_cast<uint64_t>(number(1, 5));
  if (cramped_) {
    real_store_ = true;
    options_.film_memory = static_cast<uint64_t>(number(1, 4));
    options_.unit_time = std::chrono::milliseconds(number(1, 400));
    faults_end_ = TimePoint(std::chrono::seconds(number(20, 200)));
  }
  const int jobs = cramped_ ? 3 : number(1, 3);
  for (int i = 1; i <= jobs; ++i) make_job(JobId{static_cast<uint64_t>(i)});
}

void SimulatedWorld::run() {
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
  check_disks();
  check_rows();
}

void SimulatedWorld::make_job(JobId id) {
  SimJob& job = jobs_[id];
  JobPlan& plan = job.plan;
  const bool long_one = chance(0.1);
  const int frames = long_one ? 1 : number(1, 4);
  for (int f = 1; f <= frames; ++f) plan.frames.push_back(f * 3);
  plan.region = {number(-5, 5), number(0, 5), number(6, 18), number(6, 18)};
  plan.tile_size = number(4, 9);
  plan.batches = static_cast<uint32_t>(long_one ? number(60, 140) : number(1, 9));
  if (cramped_) plan.batches += static_cast<uint32_t>(number(10, 30));
  plan.priority = number(0, 2);
  plan.owner = chance(0.5) ? "eve" : "fay";
  plan.frames_in_flight = static_cast<uint32_t>(number(1, 3));
  plan.film_bytes = static_cast<uint64_t>(number(cramped_ ? 1 : 0, 3));
  plan.max_workers = chance(0.3) ? static_cast<uint32_t>(number(1, 3)) : 0;
  if (chance(0.3)) plan.order = FrameOrder::progressive;
  plan.whole_frames = chance(0.4);
  if (choosy_) {
    if (chance(0.4)) plan.needs.tags.emplace_back("gpu");
    if (chance(0.3)) plan.needs.tags.emplace_back("quiet");
    if (chance(0.4)) plan.needs.memory = static_cast<uint64_t>(number(1, 8));
  }
  // Not by chance: worlds of old have to stay what they were.
  if (choosy_ && static_cast<uint64_t>(id) == 2) {
    plan.needs.render_class = core::RenderClass::portable;
  }
  plan.shuffle = static_cast<uint64_t>(number(0, 1));
  // Where there are workers enough of one class to check each other. Not by chance either.
  if (corrupt_ && static_cast<uint64_t>(id) != 1) plan.redundancy = 40;
  // Not by chance either.
  if (static_cast<uint64_t>(id) == 3 && !plan.whole_frames) {
    for (uint32_t round = 2; round < plan.batches; round += std::max(1U, round / 2)) {
      plan.rounds.push_back(round);
    }
  }
  for (const int32_t f : plan.frames) {
    SimFrame& frame = job.frames[f];
    frame.poisoned = chance(0.05);
    frame.refused = chance(0.03);
    frame.unfinishable = chance(0.03);
  }
  if (real_store_) job.disk = std::make_unique<SimulatedDisk>(plan, random_() | 1U);
}

void SimulatedWorld::start_coordinator() {
  ++options_.incarnation;
  scheduler_ = std::make_unique<Scheduler>(options_);
  woken_ = false;
  records_.clear();
  restoring_ = true;
  for (auto& [id, job] : jobs_) {
    if (job.ended) continue;
    if (real_store_) take_up(job);
    // What is suspect is rendered again; a frame without a row is not done, whatever its log says.
    frames_suspected += static_cast<uint64_t>(
        std::erase_if(job.rows, [](const auto& row) { return row.second.suspect; }));
    std::erase_if(job.stored.finished, [&](int32_t f) { return !job.rows.contains(f); });
    for (auto& [number, frame] : job.frames) {
      frame.batches.clear();
      frame.sum = 0;
      frame.over = false;
    }
    for (const int32_t f : job.stored.finished) job.frames[f].over = true;
    for (const int32_t f : job.stored.failed) job.frames[f].over = true;
    for (const AcceptedUnit& a : job.stored.accepted) add_to_film(job, a, 0);
    if (real_store_) set_aside_at_start(job);
    tell(JobAdded{id, job.plan, job.stored});
    if (job.paused) tell(JobPaused{id});
  }
  restoring_ = false;
}

/// With `power` its machine goes, too.
void SimulatedWorld::crash_coordinator(bool power) {
  ++restarts;
  power_cuts += power;
  std::mt19937 chances(static_cast<uint32_t>(random_()));
  for (auto& [id, job] : jobs_) {
    if (!job.disk) continue;
    if (job.disk->any_aside() || job.telling || !job.calls.empty()) {
      ++(power ? aside.power_cuts : aside.kills);
    }
    job.disk->die(power, chances);
    job.appended.clear();
    job.committing = false;
    job.calls.clear();
    job.telling = false;
    for (auto& [number, frame] : job.frames) frame.in_memory = false;
  }
  scheduler_.reset();
  ++generation_;
  lost_.clear();
  storing_.clear();
  unsettled_.clear();
  for (SimWorker& w : workers_) {
    if (!w.known_divergent) w.quarantined_by = 0;
  }
  for (SimWorker& w : workers_) w.connected = false;
  after(std::chrono::milliseconds(number(1, 5000)), [this] {
    start_coordinator();
    for (size_t i = 0; i < workers_.size(); ++i) {
      if (!workers_[i].connected) after(delay(), [this, i] { connect(i); });
    }
  });
}

void SimulatedWorld::tell(const Event& event) {
  if (!scheduler_) return;
  if (const auto* result = std::get_if<ResultArrived>(&event)) {
    if (unwelcome(*result)) return;
    const SimJob& job = jobs_.at(result->job);
    aside.results += job.disk && job.disk->is_aside(result->unit.frame);
  }
  for (const Action& action : scheduler_->handle(event, now_)) {
    std::visit([this](const auto& a) { act(a); }, action);
  }
  tell_of_lost_films();
  check_room();
  if (chance(0.02)) check_audit();
  if (const auto wake = scheduler_->next_wake(); wake && !woken_) {
    woken_ = true;
    after(std::max(*wake - now_, Duration{std::chrono::milliseconds(1)}), [this, g = generation_] {
      if (g != generation_) return;
      woken_ = false;
      tell(Tick{});
    });
  }
}

/// Whether the coordinator takes nothing from the worker, because one before it had found it out.
bool SimulatedWorld::unwelcome(const ResultArrived& result) {
  const uint64_t by = workers_[index_of(result.worker)].quarantined_by;
  if (by == 0 || by == generation_ + 1) return false;
  send(result.worker, [this, result](SimWorker& w) { drop(w, result.job, result.unit, {}); });
  tell(UnitReturned{result.worker, result.lease, result.job, result.unit});
  return true;
}

void SimulatedWorld::tell_later(const Event& event) {
  after(delay(), [this, event, g = generation_] {
    if (g == generation_) tell(event);
  });
}

void SimulatedWorld::check_audit() {
  if (!scheduler_) return;
  if (const std::string wrong = scheduler_->audit(); !wrong.empty()) fail("audit: " + wrong);
}

bool SimulatedWorld::all_ended() const {
  for (const auto& [id, job] : jobs_) {
    if (!job.ended) return false;
  }
  return true;
}

}  // namespace hyades::coordinator
