#include "coordinator/scheduler/granting.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "coordinator/scheduler/run_length.h"

namespace hyades::coordinator {
namespace {

/// A worker asks for two units per thread; wishes beyond twice as many, and some, are mistakes or
/// malice.
constexpr uint32_t kMaySpare = 64;
/// Units that a worker has at most, with those whose films nobody can take now: as many as it may
/// bring along when it comes anew.
constexpr uint32_t kMostInHand = 20'000;
/// Units of one lease: what ends a unit looks through all of its lease.
constexpr size_t kMostOfALease = 64;
/// How long a worker waits that came too late for a frame.
constexpr Duration kLookAgain = std::chrono::seconds(1);
/// Pictures of frames in work are asked for again about every second by who looks at them.
constexpr Duration kWatchedFor = std::chrono::seconds(10);
/// How often it is looked at which films can be set aside, while some have to.
constexpr Duration kRoomEvery = std::chrono::seconds(1);
/// A frame of which nobody has had a unit for so long makes room for others.
constexpr Duration kIdle = std::chrono::seconds(10);
/// How many frames of an owner's are considered that have workers enough.
constexpr size_t kPlacesLookedAt = 12;

/// Which doubling of its samples a frame is in: 0 until every tile has had one batch, p until every
/// tile has had 2^p.
uint32_t pass_of(const FrameLedger& ledger, uint32_t tiles) {
  return static_cast<uint32_t>(std::bit_width((ledger.total() - ledger.free()) / tiles));
}

/// A MayTry of the worker, which lives no longer than what it is made of.
auto judge_of(const ScheduledWorkers& workers, const ScheduledJob& job, WorkerId id,
              const Worker& worker) {
  return [&, id](const std::vector<WorkerId>& blamed, const std::vector<Witness>& heard) {
    return workers.may_try(job, id, worker, blamed, heard);
  };
}

/// The jobs of a share that have work and ask for no more than the worker has, oldest first. Those
/// that ask for the same are looked at together: many may ask for what the worker has not.
class ReadyJobs {
 public:
  ReadyJobs(const FairShare& share, const Worker& worker) {
    for (const auto& [serial, alike] : share.ready) {
      if (!alike.group->needs.are_met(worker)) continue;
      rest_.emplace_back(alike.jobs.begin(), alike.jobs.end());
    }
    std::make_heap(rest_.begin(), rest_.end(), is_younger);
  }

  /// The next one; null where there is none.
  ScheduledJob* next() {
    if (rest_.empty()) return nullptr;
    std::pop_heap(rest_.begin(), rest_.end(), is_younger);
    Rest& oldest = rest_.back();
    ScheduledJob* job = oldest.first->second;
    if (++oldest.first == oldest.second) {
      rest_.pop_back();
    } else {
      std::push_heap(rest_.begin(), rest_.end(), is_younger);
    }
    return job;
  }

 private:
  using Place = std::map<uint64_t, ScheduledJob*>::const_iterator;
  using Rest = std::pair<Place, Place>;
  static bool is_younger(const Rest& a, const Rest& b) { return a.first->first > b.first->first; }

  std::vector<Rest> rest_;
};

}  // namespace

void Granting::on(const WorkRequested& e) {
  Worker* worker = workers_.find(e.worker);
  if (worker == nullptr) return;
  const uint64_t most = std::max<uint64_t>(kMaySpare, 4 * uint64_t{worker->threads});
  const uint64_t room = kMostInHand - std::min(worker->units, kMostInHand);
  const uint64_t wish = std::min({uint64_t{worker->wanted} + e.units, most, room});
  worker->wanted = static_cast<uint32_t>(wish);
  if (may_lease()) serve(e.worker, *worker, true, true);
  workers_.update_waiting(e.worker, *worker);
}

void Granting::on(const LeasingHeld& e) {
  held_ = e.held;
  step_.work_appeared = true;
}

void Granting::on(const FrameWatched& e) {
  ScheduledJob* job = jobs_.find(e.job);
  FrameSlot* slot = job != nullptr ? job->slot(e.frame) : nullptr;
  if (slot != nullptr && slot->in_flight()) slot->watched_until = step_.now + kWatchedFor;
}

void Granting::on(const Tick&) {
  make_room();
  // Time alone changes little, and all who wait look at what there is.
  const bool was_blocked = records_.blocked_until() > served_;
  if (step_.now < records_.blocked_until()) return;
  if (!was_blocked && step_.now - served_ < kLookAgain) return;
  step_.work_appeared = true;
  turned_away_ = false;
  served_ = step_.now;
}

void Granting::serve(WorkerId id, Worker& worker, bool units, bool copies) {
  if (worker.barred || worker.wanted == 0) return;
  if (workers_.rests(id)) {
    turned_away_ = true;
    return;
  }
  while (units && worker.wanted > 0 && grant(id, worker)) {
  }
  while (copies && worker.wanted > 0 && copies_.grant(id, worker)) {
  }
}

void Granting::dispatch() {
  frames_.serve_waiting(
      [this](const ScheduledJob& job, const FrameSlot& slot) { return film_fits(job, slot); });
  if (films_.refused() && !next_room_) next_room_ = step_.now;
  if (!may_lease()) return;
  const bool copies = copies_.begin_round();
  if (std::exchange(step_.work_appeared, false)) {
    for (auto it = workers_.waiting().begin(); it != workers_.waiting().end();) {
      if (jobs_.ready_shares().empty()) break;
      serve_waiting((it++)->second, false);
    }
  }
  if (copies) offer_copies();
}

/// Offers copies to those who wait, beginning behind whom the last round came to: where very many
/// units are late a round does not come to all.
void Granting::offer_copies() {
  const std::map<uint64_t, WorkerId>& waiting = workers_.waiting();
  std::vector<std::pair<uint64_t, WorkerId>> turns(waiting.upper_bound(last_offered_),
                                                   waiting.end());
  turns.insert(turns.end(), waiting.begin(), waiting.upper_bound(last_offered_));
  for (const auto& [place, id] : turns) {
    if (!copies_.due()) return;
    last_offered_ = place;
    serve_waiting(id, true);
  }
}

void Granting::serve_waiting(WorkerId id, bool copies) {
  Worker& worker = *workers_.find(id);
  serve(id, worker, !copies, copies);
  workers_.update_waiting(id, worker);
}

std::optional<TimePoint> Granting::next_wake() const {
  std::optional<TimePoint> wake;
  if (turned_away_) wake = served_ + kLookAgain;
  if (next_room_) wake = wake ? std::min(*wake, *next_room_) : next_room_;
  if (held_ || workers_.waiting().empty()) return wake;
  const std::optional<TimePoint> copies = copies_.next_wake();
  return wake && copies ? std::min(*wake, *copies) : copies ? copies : wake;
}

/// Where the worker has a scene of another frame in memory it may stay with that one, within
/// bounds. A scene that it does not have begins with one unit, which waits while the worker goes on
/// with what it has.
bool Granting::grant(WorkerId id, Worker& worker) {
  const auto first = next_in_line(id, worker, false);
  if (!first) return false;
  const bool fresh = !Affinity::has_scene(worker, first->id());
  const bool loads = worker.prefetch == first->id() && affinity_.still_loads(worker);
  const bool here = !fresh && !loads;
  const auto loaded = here ? std::nullopt : find_loaded(id, worker, *first->job, loads);
  if (!loaded) worker.in_line = step_.now;
  if (fresh && !loaded && options_.scene_time > Duration{0} &&
      find_loaded(id, worker, *first->job, true)) {
    return grant_from(*first, id, worker, true);
  }
  const FramePlace place = loaded.value_or(*first);
  if (place.id() == worker.affinity && !worker.prefetch && affinity_.nearly_leased(place)) {
    const auto next = next_in_line(id, worker, true);
    if (next && grant_from(*next, id, worker, true)) return true;
  }
  return grant_from(place, id, worker, false);
}

/// Priorities first, then who has less, then the older job, then the earlier frame. `fresh`: of the
/// scenes that the worker does not have.
std::optional<FramePlace> Granting::next_in_line(WorkerId id, const Worker& worker, bool fresh) {
  bool begun = frames_.film_is_next();
  for (const auto& [order, share] : jobs_.ready_shares()) {
    if (const auto place = next_of(*share, id, worker, fresh, begun)) return place;
  }
  return std::nullopt;
}

/// The first frame of the share that the worker had better take; where all have workers enough, the
/// one with most to do. Where a frame waits for room for its film `begun` is set, for all that
/// follow: of these only frames that have begun count, so that a large film gets room some time,
/// and small ones that leave it. Whose films take most of the room holds up nobody else.
std::optional<FramePlace> Granting::next_of(const FairShare& share, WorkerId id,
                                            const Worker& worker, bool fresh, bool& begun) {
  std::optional<FramePlace> roomiest;
  double most = -1;
  size_t looked = 0;
  bool own = false;  // of this owner's
  const auto is_held_up = [&](const ScheduledJob& job) {
    return !films_.is_next(job) && (own || (begun && !films_.leaves_room(job)));
  };
  ReadyJobs ready(share, worker);
  while (ScheduledJob* job = ready.next()) {
    if (!ScheduledWorkers::may_join(*job, id, worker)) continue;
    own = own || frames_.film_is_next_of(job->plan.owner);
    if (job->plan.order == FrameOrder::progressive) {
      const auto slot = find_pass(*job, id, worker, is_held_up(*job));
      if (slot && !(fresh && Affinity::has_scene(worker, FramePlace{job, *slot}.id()))) {
        return FramePlace{job, *slot};
      }
      continue;
    }
    for (const uint32_t slot : job->in_flight) {
      const FramePlace place{job, slot};
      const FrameSlot& frame = place.frame();
      if (frame.phase == FramePhase::rendering && !frame.film) {
        // One that was set aside may have nothing for anybody who is here.
        if (!has_units_for(*job, frame, id, worker)) continue;
        const bool fits = film_fits(*job, frame);
        const bool held_up = is_held_up(*job);
        own = own || !fits;
        begun = begun || (!fits && films_.may_hold_up(*job));
        if (!fits || held_up) continue;
      }
      const Suits suits = suits_at(place, id, worker, fresh);
      if (suits == Suits::yes) return place;
      if (suits == Suits::no) continue;
      const double left = affinity_.seconds_left(place, frame.threads() + worker.threads);
      if (left > most) {
        most = left;
        roomiest = place;
      }
      if (++looked == kPlacesLookedAt) return roomiest;
    }
  }
  return roomiest;
}

/// Who has the frame's scene is welcome as long as there is something for them; others while it has
/// too few workers. Those who come too late are turned away.
Granting::Suits Granting::suits_at(const FramePlace& place, WorkerId id, const Worker& worker,
                                   bool fresh) {
  if (!has_work_for(*place.job, place.frame(), id, worker)) return Suits::no;
  if (Affinity::has_scene(worker, place.id())) return fresh ? Suits::no : Suits::yes;
  // Scenes are loaded one after the other.
  if (affinity_.still_loads(worker)) {
    turned_away_ = true;
    return Suits::no;
  }
  if (!affinity_.crowded(place, worker)) return Suits::yes;
  if (affinity_.too_late(place, worker)) {
    turned_away_ = true;
    return Suits::no;
  }
  return Suits::if_nothing_else;
}

/// Whether there is something of the frame for this worker.
bool Granting::has_work_for(const ScheduledJob& job, const FrameSlot& slot, WorkerId id,
                            const Worker& worker) const {
  return slot.phase == FramePhase::rendering && has_units_for(job, slot, id, worker) &&
         film_fits(job, slot);
}

/// Whether there is something of the frame, which is in work, for this worker, if its film fits.
bool Granting::has_units_for(const ScheduledJob& job, const FrameSlot& slot, WorkerId id,
                             const Worker& worker) const {
  if (!workers_.may_render(job, slot, worker)) return false;
  const auto judge = judge_of(workers_, job, id, worker);
  const MayTry allowed = std::ref(judge);
  return slot.ledger->has_work(allowed) ||
         slot.ledger->next_check(worker.witness, allowed).has_value();
}

/// Of a progressive job, the frame in the lowest pass; `begun`: of those that have begun.
std::optional<uint32_t> Granting::find_pass(const ScheduledJob& job, WorkerId id,
                                            const Worker& worker, bool begun) const {
  std::optional<uint32_t> best;
  uint32_t best_pass = 0;
  for (const uint32_t index : job.in_flight) {
    if (begun && !job.slots[index].film) continue;
    if (!has_work_for(job, job.slots[index], id, worker)) continue;
    const uint32_t pass = pass_of(*job.slots[index].ledger, job.grid.size());
    if (best && pass >= best_pass) continue;
    best = index;
    best_pass = pass;
  }
  return best;
}

/// Units of one frame, as many as the worker wants and the frame has; `ahead`: one, so that its
/// scene is loaded while the worker is busy with another.
bool Granting::grant_from(const FramePlace& place, WorkerId id, Worker& worker, bool ahead) {
  ScheduledJob& job = *place.job;
  FrameSlot& slot = place.frame();
  const auto judge = judge_of(workers_, job, id, worker);
  const MayTry allowed = std::ref(judge);
  if (!Affinity::has_scene(worker, place.id())) {
    affinity_.begin_loading(worker, place.id(), worker.leases.empty());
  }
  Affinity::remember_scene(worker, place.id(), ahead);
  if (ahead) {
    affinity_.prefetch(worker, place.id());
  } else {
    affinity_.settle(worker, place.id());
  }
  slot.last_leased = step_.now;
  if (grant_check(place, id, worker, allowed)) return true;
  std::vector<Extent> extents;
  const size_t most = ahead ? 1 : std::min<size_t>(worker.wanted, kMostOfALease);
  while (extents.size() < most) {
    const auto extent =
        slot.ledger->next(allowed, [&](uint32_t tile) { return run_length_of(job, slot, tile); });
    if (!extent) break;
    copies_.note(place, leases_.assign(slot, *extent, id), worker.class_for(job));
    extents.push_back(*extent);
  }
  if (extents.empty()) return false;
  slot.worker_class = worker.class_for(job);
  worker.wanted -= static_cast<uint32_t>(extents.size());
  leases_.grant(id, worker, place, std::move(extents));
  jobs_.update_offer(job);
  frames_.open(job);
  return true;
}

uint32_t Granting::run_length_of(const ScheduledJob& job, const FrameSlot& slot,
                                 uint32_t tile) const {
  const FrameLedger& ledger = *slot.ledger;
  const double cost = job.batch_seconds(tile);
  if (cost <= 0) return 1;
  uint64_t left = std::max(jobs_.offered(), ledger.free());
  if (job.in_flight.size() < job.plan.frames_in_flight) {
    left += job.waiting * ledger.total();
  }
  uint64_t run = run_length(cost, options_.unit_time, left, workers_.threads());
  if (job.plan.order == FrameOrder::progressive || step_.now < slot.watched_until) {
    // No tile gets ahead of its frame's pass.
    const uint32_t pass = pass_of(ledger, job.grid.size());
    run = std::min(run, uint64_t{1} << std::min(pass == 0 ? 0 : pass - 1, 31U));
  }
  return static_cast<uint32_t>(run);
}

/// A frame whose scene the worker has, though `first` is next in line. Bounded in three ways, so
/// that nobody starves: the priority is that of `first`, the owner has not much more out than that
/// of `first`, and after `affinity_time` the worker takes what is next in line. While it `loads`
/// the scene of `first`, only the priority counts.
std::optional<FramePlace> Granting::find_loaded(WorkerId id, const Worker& worker,
                                                const ScheduledJob& first, bool loads) const {
  if (!loads && step_.now - worker.in_line >= options_.affinity_time) return std::nullopt;
  const FairShare& next = *first.share;
  const uint64_t most = next.running + next.running / 4 + 2 * uint64_t{worker.threads};
  for (auto scene = worker.scenes.rbegin(); scene != worker.scenes.rend(); ++scene) {
    ScheduledJob* job = jobs_.find(scene->job);
    if (job == nullptr || !job->ready || job->plan.order != FrameOrder::sequential) continue;
    const FairShare& share = *job->share;
    if (share.priority != next.priority || (!loads && share.running > most)) continue;
    if (!ScheduledWorkers::may_join(*job, id, worker)) continue;
    const FrameSlot* slot = job->slot(scene->frame);
    if (!has_work_for(*job, *slot, id, worker)) continue;
    return FramePlace{job, job->index_of(*slot)};
  }
  return std::nullopt;
}

/// Whether the frame has a film, unless it is others' turn; or it fits beside those of other
/// frames; or these cannot be set aside though nobody works at any.
bool Granting::film_fits(const ScheduledJob& job, const FrameSlot& slot) const {
  if (slot.film) return slot.stays_until > step_.now || !films_.must_yield(job);
  if (films_.has_room(job) && !films_.has_yielded(job)) {
    films_.expect(job);
    return true;
  }
  if (crammed_ && films_.has_room_in_need(job) && !any_film_in_work()) return true;
  films_.refuse(job);
  return false;
}

/// Has films set aside: those of paused jobs in any case, as they may stay so for ever. Where
/// others have no room also those of frames that nobody has worked at for a while: their jobs have
/// no workers, so that nobody is held up. Or else those that whoever has most of the room lets go
/// in turn.
void Granting::make_room() {
  if (!next_room_ || step_.now < *next_room_) return;
  if (const auto next = films_.next()) {
    const ScheduledJob* job = jobs_.find(*next);
    if (job == nullptr || !job->ready) films_.forget(*next);
  }
  bool paused = false;  // films of paused jobs are there
  bool soon = false;    // some can be set aside later, or somebody works at them
  uint64_t leaving = 0;
  std::vector<FramePlace> idle;
  for (const auto& [id, index] : films_.holders()) {
    const FramePlace place{jobs_.find(id), index};
    FrameSlot& slot = place.frame();
    paused = paused || place.job->paused;
    soon = soon || (slot.ledger && !slot.ledger->idle());
    if (!slot.leaving && slot.stays_until <= step_.now && FrameLifecycle::may_leave(slot)) {
      if (place.job->paused) {
        frames_.set_aside(*place.job, slot);
      } else if (step_.now - std::max(slot.last_leased, slot.film_since) >= kIdle ||
                 films_.must_yield(*place.job)) {
        idle.push_back(place);
      } else {
        soon = true;
      }
    }
    if (slot.leaving) leaving += place.job->plan.film_bytes;
  }
  std::stable_sort(idle.begin(), idle.end(), [](const FramePlace& a, const FramePlace& b) {
    return a.frame().last_leased < b.frame().last_leased;
  });
  for (const FramePlace& place : idle) {
    if (!films_.refused() || leaving >= films_.lacking()) break;
    frames_.set_aside(*place.job, place.frame());
    leaving += place.job->plan.film_bytes;
  }
  crammed_ = films_.refused() && leaving == 0 && !soon;
  if (crammed_ && !any_film_in_work()) films_.serve_refused();
  next_room_.reset();
  if (films_.refused() || paused) next_room_ = step_.now + kRoomEvery;
}

/// Whether a unit is out, a film is on its way to the disk, or a frame is being finished: there
/// will be room, or something else will be out.
bool Granting::any_film_in_work() const {
  if (!leases_.empty() || !records_.empty()) return true;
  return std::any_of(jobs_.all().begin(), jobs_.all().end(), [](const auto& entry) {
    const ScheduledJob& job = *entry.second;
    return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
      const FrameSlot& slot = job.slots[i];
      return slot.film && (slot.over() || slot.phase == FramePhase::finishing);
    });
  });
}

bool Granting::waits_for_film(const ScheduledJob& job) const {
  if (job.paused) return false;
  return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
    const FrameSlot& slot = job.slots[i];
    return slot.awaits_film || (slot.phase == FramePhase::rendering && !film_fits(job, slot));
  });
}

/// Gives the worker a disputed unit that it has not rendered.
bool Granting::grant_check(const FramePlace& place, WorkerId id, Worker& worker,
                           const MayTry& may_try) {
  const auto extent = place.frame().ledger->next_check(worker.witness, may_try);
  if (!extent) return false;
  copies_.note(place, leases_.assign(place.frame(), *extent, id), worker.class_for(*place.job));
  --worker.wanted;
  leases_.grant(id, worker, place, {*extent});
  jobs_.update_offer(*place.job);
  return true;
}

}  // namespace hyades::coordinator
