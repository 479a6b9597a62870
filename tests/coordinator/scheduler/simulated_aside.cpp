// Films that leave memory and come back, as the film store of a job has it.
#include <utility>

#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

void SimulatedWorld::FilmsAsideSeen::add(const FilmsAsideSeen& other) {
  done += other.done;
  at_start += other.at_start;
  refused += other.refused;
  asked_twice += other.asked_twice;
  fetched += other.fetched;
  lost += other.lost;
  results += other.results;
  voids += other.voids;
  compactions += other.compactions;
  power_cuts += other.power_cuts;
  kills += other.kills;
}

void SimulatedWorld::act(const SetAside& a) {
  const bool refuse = fault();
  if (!real_store_) return tell_later(FilmSetAside{a.job, a.frame, !refuse});
  SimJob& job = jobs_.at(a.job);
  aside.asked_twice += job.frames.at(a.frame).asked_aside++ > 0;
  job.calls.emplace_back([this, a, refuse, &job] { set_aside(job, a, refuse); });
  after(delay(), [this, &job, g = generation_] {
    if (g == generation_) run_calls(job);
  });
}

/// What is set aside is what was merged until now. Until somebody has heard of it the store does
/// nothing else, but much may happen.
void SimulatedWorld::set_aside(SimJob& job, const SetAside& a, bool refuse) {
  if (job.ended) return;
  SimFrame& frame = job.frames.at(a.frame);
  FaultyFiles& files = job.disk->files();
  const bool troubled = cramped_ && now_ < faults_end_ && fault_rate_ > 0;
  job.telling = true;
  bool power_goes = false;
  if (refuse && frame.in_memory) {
    power_goes = cramped_ && chance(0.3);
    if (power_goes) {
      files.fail_from_operation(files.operations() + static_cast<uint64_t>(number(0, 8)));
    } else {
      files.fail_next_write_after(0);
    }
  }
  bool done = true;
  if (frame.in_memory) {
    done = job.disk->set_aside(a.frame, frame.film, frame.worker_class).ok();
    ++(done ? aside.done : aside.refused);
  }
  if (done && frame.in_memory) {
    frame.digest = frame.film.digest();
    frame.film = job.disk->blank();
    frame.in_memory = false;
    if (troubled && chance(0.03)) job.disk->damage_aside(a.frame);
  }
  const bool dies = power_goes || (troubled && chance(0.03));
  const bool waits = troubled && chance(0.3);
  after(std::chrono::milliseconds(waits ? number(0, 20'000) : 0),
        [this, a, done, dies, power_goes, &job, g = generation_] {
          if (g != generation_) return;
          if (dies) return crash_coordinator(power_goes || chance(0.5));
          job.telling = false;
          --job.frames.at(a.frame).asked_aside;
          if (!job.ended) tell(FilmSetAside{a.job, a.frame, done});
          settle(job, job.heard);
        });
}

void SimulatedWorld::call(SimJob& job, std::function<void()> what) {
  job.calls.push_back(std::move(what));
  run_calls(job);
}

void SimulatedWorld::run_calls(SimJob& job) {
  while (!job.telling && !job.calls.empty()) {
    const std::function<void()> what = std::move(job.calls.front());
    job.calls.pop_front();
    if (!job.ended) what();
  }
}

bool SimulatedWorld::fetch(SimJob& job, int32_t number) {
  if (!job.disk->is_aside(number)) return true;
  SimFrame& frame = job.frames.at(number);
  auto film = job.disk->fetch(number);
  if (!film) {
    ++aside.lost;
    frame.lost = true;
    for (const auto& [id, one] : jobs_) {
      if (&one == &job) lost_.emplace_back(id, number);
    }
    return false;
  }
  ++aside.fetched;
  if (film->digest() != frame.digest) fail("a film comes back as another");
  frame.film = std::move(*film);
  frame.in_memory = true;
  return true;
}

void SimulatedWorld::forget_film(SimJob& job, SimFrame& frame, int32_t number) {
  frame.in_memory = false;
  if (job.disk) job.disk->forget_aside(number);
}

/// What would be merged with them would else be taken for all.
void SimulatedWorld::tell_of_lost_films() {
  while (!lost_.empty()) {
    const auto [job, frame] = lost_.back();
    lost_.pop_back();
    tell(FrameRefused{job, frame, "its film is lost"});
  }
}

/// As a coordinator that begins: no film comes into memory by itself.
void SimulatedWorld::set_aside_at_start(SimJob& job) {
  job.stored.set_aside.clear();
  for (auto& [number, frame] : job.frames) {
    if (frame.over) forget_film(job, frame, number);
    if (!job.disk->is_aside(number)) continue;
    ++aside.at_start;
    job.stored.set_aside.push_back(number);
  }
}

/// All that is in memory counts, or films would take more than there is.
void SimulatedWorld::check_room() {
  if (!scheduler_ || !real_store_) return;
  uint64_t bytes = 0;
  for (const auto& [id, job] : jobs_) {
    if (job.ended) continue;
    for (const auto& [number, frame] : job.frames) {
      if (frame.in_memory) bytes += job.plan.film_bytes;
    }
  }
  if (bytes > scheduler_->films()) fail("films are in memory that nobody counts");
}

}  // namespace hyades::coordinator
