#include "coordinator/scheduler/frame_lifecycle.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace hyades::coordinator {
namespace {

/// A class that may be somebody's invention takes no longer for a frame.
constexpr Duration kLongestFrame = std::chrono::hours(24);
/// How many times its patience lets the farm do without slow workers' beginnings.
constexpr int kSlowFor = 12;
/// Failed frames of a job that begin again together.
constexpr uint32_t kReturnAtOnce = 1000;
/// A film that could not be set aside stays for so long.
constexpr Duration kStays = std::chrono::seconds(10);
/// Frames that wait for their films, of which it is looked at once whether these fit.
constexpr int kWaitingLookedAt = 64;

}  // namespace

void FrameLifecycle::on(const FrameOpened& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  if (slot == nullptr || slot->phase != FramePhase::opening) return;
  slot->phase = FramePhase::rendering;
  if (slot->suspect) return restart(*job, *slot);
  void_suspect_tiles(*job, *slot);  // what it has from before a restart
  if (slot->ledger->to_judge().empty() || !await_film(*job, *slot)) go_on(*job, *slot);
  jobs_.update_offer(*job);
  finish_if_complete(*job, *slot);  // a frame without pixels
}

void FrameLifecycle::on(const FrameRefused& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  if (slot == nullptr) return;
  const FramePhase phase = slot->phase;
  if (phase != FramePhase::opening && phase != FramePhase::rendering &&
      phase != FramePhase::finishing) {
    return;
  }
  fail(*job, *slot, e.reason);
}

void FrameLifecycle::on(const FilmSetAside& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  // Somebody may have come to work at it meanwhile, so that it is fetched back.
  if (slot == nullptr || !std::exchange(slot->leaving, false)) return;
  if (e.done) return films_.drop(*job, *slot);
  slot->stays_until = step_.now + kStays;
}

bool FrameLifecycle::may_leave(const FrameSlot& slot) {
  return !slot.suspect && slot.ledger && slot.ledger->idle() && !slot.ledger->complete() &&
         (slot.phase == FramePhase::rendering || slot.phase == FramePhase::waiting);
}

void FrameLifecycle::set_aside(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = true;
  step_.say(SetAside{job.id, slot.frame});
}

void FrameLifecycle::on(const FinishDone& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (goes_back(*job, *slot)) return;
  if (slot->suspect) return restart(*job, *slot);
  slot->phase = FramePhase::closing;
  records_.persist(FrameFinishedRecord{job->id, slot->frame});
}

void FrameLifecycle::on(const FinishFailed& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (goes_back(*job, *slot)) return;
  if (++slot->finish_attempts < job->plan.max_attempts) {
    say_finish(*job, *slot);
  } else {
    fail(*job, *slot, e.reason);
  }
}

void FrameLifecycle::on(const TileJudged& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.frame});
  const auto tile = job ? job->grid.index_of(e.tile) : std::nullopt;
  if (!tile || slot->phase != FramePhase::rendering) return;
  if (!slot->ledger->judge(*tile, e.serial, e.enough)) return;
  if (e.enough) {
    step_.say(TileSpared{job->id, slot->frame, e.tile, slot->ledger->planned(*tile)});
  }
  jobs_.update_offer(*job);
  open(*job);
  finish_if_complete(*job, *slot);
}

void FrameLifecycle::open(ScheduledJob& job) {
  if (job.paused) return;
  const uint64_t frame_total = uint64_t{job.grid.size()} * job.plan.first_batches();
  const uint64_t enough = std::max(frame_total / 2, 2 * workers_.threads());
  const size_t most = std::max(job.plan.frames_in_flight, 1U);
  while (job.in_flight.size() < 2 * most) {
    uint64_t free = 0;
    size_t lone = 0;  // frames that others do not wait for
    bool room = false;
    for (const uint32_t i : job.in_flight) {
      const FrameSlot& slot = job.slots[i];
      if (workers_.is_lone(job, slot.worker_class)) {
        ++lone;
        continue;
      }
      if (slot.phase == FramePhase::opening || slot.phase == FramePhase::rendering) {
        free += slot.ledger->free() + slot.ledger->likely_more();
        room = room || affinity_.has_room({&job, i});
      }
    }
    if (job.in_flight.size() - lone >= most) return;
    if (room && free > enough && job.plan.order == FrameOrder::sequential) return;
    while (job.next_slot < job.slots.size() &&
           job.slots[job.next_slot].phase != FramePhase::waiting) {
      ++job.next_slot;
    }
    if (job.next_slot == job.slots.size()) return;
    const auto index = static_cast<uint32_t>(job.next_slot);
    FrameSlot& slot = job.slots[index];
    slot.phase = FramePhase::opening;
    --job.waiting;
    if (!slot.ledger) {
      slot.ledger =
          std::make_unique<FrameLedger>(job.grid.order(), job.plan.batches, job.plan.rounds);
    }
    job.in_flight.push_back(index);
    step_.say(OpenFrame{job.id, slot.frame});
  }
}

void FrameLifecycle::finish_if_complete(ScheduledJob& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::rendering && slot.ledger->complete()) finish(job, slot);
}

/// Whether the frame, whose outputs were to be made, is rendered again, or goes on until a conflict
/// is settled.
bool FrameLifecycle::goes_back(ScheduledJob& job, FrameSlot& slot) {
  if (job.begins_again(slot)) {
    restart(job, slot);
  } else if (!slot.ledger->settled()) {
    reopen(job, slot);
  } else {
    return false;
  }
  return true;
}

/// Whether the frame's film has left memory and has to wait for room.
bool FrameLifecycle::await_film(const ScheduledJob& job, FrameSlot& slot) {
  if (slot.film || (waiting_.empty() && films_.has_room(job))) return false;
  if (!std::exchange(slot.awaits_film, true)) waiting_.push_back({job.id, slot.frame});
  return true;
}

void FrameLifecycle::serve_waiting(
    const std::function<bool(const ScheduledJob& job, const FrameSlot& slot)>& fits) {
  film_is_next_ = false;
  owners_waiting_.clear();
  int looked = 0;
  for (auto it = waiting_.begin();
       it != waiting_.end() && !film_is_next_ && looked < kWaitingLookedAt; ++looked) {
    const auto [job, slot] = jobs_.find_frame(*it);
    const bool waits = slot != nullptr && slot->awaits_film;
    if (waits && !slot->film && (film_is_next_of(job->plan.owner) || !fits(*job, *slot))) {
      film_is_next_ = films_.may_hold_up(*job);
      owners_waiting_.insert(job->plan.owner);
      ++it;
      continue;
    }
    it = waiting_.erase(it);
    if (!waits) continue;
    slot->awaits_film = false;
    films_.take(*job, *slot);
    go_on(*job, *slot);
  }
}

/// Does what is next where no unit is leased: the film is in memory, or has room.
void FrameLifecycle::go_on(ScheduledJob& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::finishing) {
    // While it waited a worker that had a part in it was found divergent.
    if (goes_back(job, slot)) return;
    if (slot.suspect) return restart(job, slot);
    return say_finish(job, slot);
  }
  if (slot.phase != FramePhase::rendering) return;
  for (const uint32_t tile : slot.ledger->to_judge()) judge_if_due(job, slot, tile);
}

void FrameLifecycle::finish(ScheduledJob& job, FrameSlot& slot) {
  // Late films may have overtaken units that are still out.
  leases_.take_back(job, slot);
  slot.phase = FramePhase::finishing;
  if (await_film(job, slot)) return;
  films_.take(job, slot);
  say_finish(job, slot);
}

void FrameLifecycle::say_finish(const ScheduledJob& job, const FrameSlot& slot) {
  uint64_t volume = 0;
  for (uint32_t tile = 0; tile < job.grid.size(); ++tile) {
    volume += static_cast<uint64_t>(job.grid.tile(tile).area()) * slot.ledger->planned(tile);
  }
  step_.say(FinishFrame{job.id, slot.frame, volume, slot.ledger->unconfirmed()});
}

void FrameLifecycle::judge_if_due(const ScheduledJob& job, FrameSlot& slot, uint32_t tile) {
  FrameLedger& ledger = *slot.ledger;
  if (slot.phase != FramePhase::rendering || !ledger.is_to_judge(tile)) return;
  films_.take(job, slot);
  ledger.ask(tile, ++last_question_);
  step_.say(
      JudgeTile{job.id, slot.frame, job.grid.tile(tile), ledger.planned(tile), last_question_});
}

void FrameLifecycle::fail(ScheduledJob& job, FrameSlot& slot, std::string reason) {
  slot.phase = FramePhase::closing;
  slot.awaits_film = false;
  slot.reason = std::move(reason);
  leases_.take_back(job, slot);
  slot.ledger.reset();
  jobs_.update_offer(job);
  records_.persist(FrameFailedRecord{job.id, {slot.frame, slot.reason}});
}

void FrameLifecycle::fail_or_leave(ScheduledJob& job, FrameSlot& slot, WorkerId worker,
                                   std::string reason) {
  const Worker* who = workers_.find(worker);
  const bool others = who != nullptr && workers_.is_lone(job, slot.worker_class) &&
                      note_left(slot, who->origin) &&
                      workers_.anybody_with_better_claim(job, slot, *who);
  if (!others) return fail(job, slot, std::move(reason));
  restart(job, slot);
}

/// Notes that workers of this origin have left the frame under its class. Whether there was room.
bool FrameLifecycle::note_left(FrameSlot& slot, Origin origin) const {
  constexpr size_t kMost = 16;  // else whoever invents classes would fill memory
  std::erase_if(slot.left, [this](const FrameSlot::Left& left) { return left.until <= step_.now; });
  if (slot.left.size() >= kMost) return false;
  slot.left.push_back({origin, slot.worker_class, step_.now + kSlowFor * options_.class_patience});
  return true;
}

void FrameLifecycle::restart(ScheduledJob& job, FrameSlot& slot) {
  slot.phase = FramePhase::restarting;
  slot.awaits_film = false;
  slot.suspect = false;
  leases_.take_back(job, slot);
  slot.ledger.reset();
  jobs_.update_offer(job);
  records_.persist(FrameRestartedRecord{job.id, slot.frame});
}

void FrameLifecycle::bring_back_failed(ScheduledJob& job) {
  size_t& next = *job.bring_back_from;
  for (; next < job.slots.size() && job.returning < kReturnAtOnce; ++next) {
    if (job.slots[next].phase == FramePhase::failed) bring_back(job, job.slots[next]);
  }
  if (next == job.slots.size()) job.bring_back_from.reset();
}

void FrameLifecycle::bring_back(ScheduledJob& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::failed) {
    --job.frames_failed;
    ++job.returning;
    slot.phase = FramePhase::returning;
    records_.persist(FrameRestartedRecord{job.id, slot.frame});
    return;
  }
  if (slot.phase == FramePhase::waiting) --job.waiting;
  if (slot.phase == FramePhase::done) --job.frames_done;
  job.in_flight.push_back(job.index_of(slot));
  restart(job, slot);
}

void FrameLifecycle::void_suspect_tiles(const ScheduledJob& job, FrameSlot& slot) {
  if (slot.phase != FramePhase::rendering) return;
  for (const uint32_t tile : slot.ledger->newly_suspect()) {
    records_.persist(TileVoidedRecord{job.id, slot.frame, job.grid.tile(tile)});
  }
}

/// A conflict showed while the outputs were made: the frame goes on until it is settled.
void FrameLifecycle::reopen(ScheduledJob& job, FrameSlot& slot) {
  slot.phase = FramePhase::rendering;
  slot.suspect = false;
  step_.say(FrameReopened{job.id, slot.frame});
  void_suspect_tiles(job, slot);
  jobs_.update_offer(job);
}

void FrameLifecycle::restarted(ScheduledJob& job, FrameSlot& slot) {
  const uint32_t index = job.index_of(slot);
  if (slot.phase == FramePhase::returning && --job.returning == 0 && job.bring_back_from) {
    bring_back_failed(job);
  }
  slot.phase = FramePhase::waiting;
  films_.drop(job, slot);
  ++job.waiting;
  slot.worker_class = ClassId{};
  slot.orphaned.reset();
  slot.watch.reset();
  slot.finish_attempts = 0;
  slot.reason.clear();
  std::erase(job.in_flight, index);
  job.next_slot = std::min<size_t>(job.next_slot, index);
  step_.say(FrameRestarted{job.id, slot.frame});
  open(job);
}

void FrameLifecycle::restart_stranded(bool leasing) {
  if (options_.class_patience <= Duration{0} || step_.now < next_look_) return;
  next_look_ = step_.now + options_.class_patience / 4;
  if (workers_.forgive_slow()) step_.work_appeared = true;
  if (workers_.threads() == 0) return;
  for (const auto& [id, job] : jobs_.all()) {
    const std::vector<uint32_t> in_flight = job->in_flight;
    for (const uint32_t i : in_flight) {
      FrameSlot& slot = job->slots[i];
      if (slot.phase != FramePhase::rendering || slot.worker_class == ClassId{}) continue;
      if (const auto since = stands_still_since(*job, slot, leasing)) {
        ++slot.stood_still;
        // Who had no unit of it does something else.
        if (slot.ledger->any_assigned() || !slot.ledger->settled()) {
          for (const Origin origin : workers_.origins_of(slot.worker_class)) {
            note_left(slot, origin);
          }
          workers_.note_slow(slot.worker_class, *since, slot.ledger->holders_since(*since),
                             step_.now + kSlowFor * options_.class_patience);
        }
        restart(*job, slot);
      } else if (is_orphaned(*job, slot)) {
        restart(*job, slot);
      }
    }
  }
}

/// Whether nobody of the frame's class has been there for too long; keeps since when that is so.
bool FrameLifecycle::is_orphaned(const ScheduledJob& job, FrameSlot& slot) {
  if (job.paused) return false;
  if (workers_.anybody_for(job, slot.worker_class)) {
    slot.orphaned.reset();
    return false;
  }
  if (!slot.orphaned) slot.orphaned = step_.now;
  return step_.now >= *slot.orphaned + options_.class_patience && !slot.ledger->all_held();
}

/// Since when the frame's class, which may be somebody's invention, gets on with it too slowly
/// while others wait for it; nothing where it does not. Begins and ends the watch over that.
std::optional<TimePoint> FrameLifecycle::stands_still_since(const ScheduledJob& job,
                                                            FrameSlot& slot, bool leasing) {
  const FrameLedger& ledger = *slot.ledger;
  const bool watched = leasing && !job.paused && workers_.is_lone(job, slot.worker_class) &&
                       workers_.anybody_for(job, slot.worker_class) && !ledger.all_held() &&
                       workers_.anybody_of_another(job, slot.worker_class);
  if (!watched) {
    slot.watch.reset();
    return std::nullopt;
  }
  if (!slot.watch) slot.watch = FrameSlot::Watch{step_.now, ledger.durable()};
  Duration patience = options_.class_patience * (1U << std::min(slot.stood_still, 10U));
  if (films_.refused()) patience /= 4;  // others wait for the room of its film too
  const auto [since, durable] = *slot.watch;
  if (step_.now < since + patience) return std::nullopt;
  slot.watch.reset();
  const double part = seconds(step_.now - since) / seconds(kLongestFrame);
  const bool enough =
      ledger.durable() > durable &&
      static_cast<double>(ledger.durable() - durable) >= part * static_cast<double>(ledger.total());
  return enough ? std::nullopt : std::optional(since);
}

std::optional<TimePoint> FrameLifecycle::next_wake() const {
  if (options_.class_patience <= Duration{0}) return std::nullopt;
  if (jobs_.all().empty() || workers_.threads() == 0) return std::nullopt;
  return next_look_;
}

void FrameLifecycle::over(ScheduledJob& job, FrameSlot& slot, FramePhase phase) {
  // While that was stored a worker that had a part in it was found divergent.
  if (phase == FramePhase::done && (slot.suspect || !slot.ledger->settled())) {
    return restart(job, slot);
  }
  slot.phase = phase;
  films_.drop(job, slot);
  slot.ledger.reset();
  std::erase(job.in_flight, job.index_of(slot));
  if (phase == FramePhase::done) {
    ++job.frames_done;
    step_.say(FrameDone{job.id, slot.frame});
  } else {
    ++job.frames_failed;
    step_.say(FrameFailed{job.id, slot.frame, std::exchange(slot.reason, {})});
  }
  open(job);
  jobs_.end_if_over(job);
}

}  // namespace hyades::coordinator
