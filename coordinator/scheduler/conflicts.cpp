// Renderings of one unit that differ: others decide who is wrong, and what that one did is done
// again.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/scheduler/scheduler.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {
namespace {

/// With so many different answers it is not the machines: the unit is no pure function.
constexpr size_t kMostAnswers = 5;

}  // namespace

/// One more answer for a unit that is held. True where it is now known that it is right and what is
/// held is wrong.
bool Scheduler::weigh(JobState& job, FrameSlot& slot, const Extent& extent,
                      const ResultArrived& e) {
  FrameState& books = *slot.books;
  const HeldRecord held = *books.find_held(extent);
  Dispute* dispute = books.find_dispute(extent);
  if (dispute == nullptr) {
    if (held.digest == e.digest) {
      // Who sends the same again agrees with nobody, and who it was before a restart is not known.
      if (held.worker != WorkerId{} && held.worker != e.worker) {
        books.verify(extent);
        confirm(job, slot, held.worker);
        confirm(job, slot, e.worker);
      }
      return false;
    }
    dispute = &books.open_dispute(extent, {held.worker, held.digest});
    mark_disputed(job);
  }
  std::vector<Opinion>& opinions = dispute->opinions;
  if (std::none_of(opinions.begin(), opinions.end(),
                   [&](const Opinion& o) { return o.worker == e.worker; })) {
    if (held.digest != e.digest) say(Conflict{e.job, e.unit, held.worker, e.worker});
    opinions.push_back({e.worker, e.digest});
    const auto agree = std::count_if(opinions.begin(), opinions.end(), [&](const Opinion& o) {
      return o.worker != WorkerId{} && o.digest == e.digest;
    });
    if (agree > 1) {
      decide(job, slot, Dispute(*dispute), e);
      return held.digest != e.digest;
    }
    if (opinions.size() >= kMostAnswers) {
      const core::PixelRect tile = job.grid.tile(extent.tile);
      fail_frame(job, slot,
                 fmt::format("{} workers rendered tile {},{} batches {}-{} to {} different films",
                             kMostAnswers, tile.x0, tile.y0, extent.batches.first,
                             extent.batches.end() - 1, kMostAnswers));
      return false;
    }
  }
  update_ready(job);
  return false;
}

/// Two workers agree, of whom `e` is the second: the others are wrong.
void Scheduler::decide(JobState& job, FrameSlot& slot, const Dispute& dispute,
                       const ResultArrived& e) {
  FrameState& books = *slot.books;
  const Extent extent = dispute.extent;
  for (const Holder& holder : books.end_assignment(extent)) {
    drop_from_lease(holder.lease, extent);
    if (holder.lease != e.lease) say(Revoke{holder.worker, holder.lease, job.id, e.unit});
  }
  books.end_dispute(extent);
  const bool right = books.find_held(extent)->digest == e.digest;
  if (right) {
    books.verify(extent);
  } else if (job.plan.whole_frames) {
    doubt_frame(job, slot);  // and its books with it
  } else {
    books.doubt_tile(extent.tile);
  }
  for (const Opinion& o : dispute.opinions) {
    if (o.digest == e.digest) {
      confirm(job, slot, o.worker);
      continue;
    }
    doubt_films_of(o.worker);
    if (o.worker == WorkerId{}) continue;
    const std::string reason = fmt::format(
        "rendered job {} frame {} tile {},{} batches {}-{} to other bits than two "
        "other workers",
        static_cast<uint64_t>(job.id), slot.frame, e.unit.tile.x0, e.unit.tile.y0,
        extent.batches.first, extent.batches.end() - 1);
    quarantine(o.worker, reason);
    ++odd_records_;
    persist(WorkerOddRecord{job.id, slot.frame, o.worker, reason}, {});
  }
  void_doubted(job, slot);
  update_ready(job);
  complete_if_so(job, slot);
}

/// The worker could be trusted when it rendered a unit of this frame.
void Scheduler::confirm(const JobState& job, const FrameSlot& slot, WorkerId worker) {
  if (worker != WorkerId{}) say(Confirmed{worker, job.id, slot.frame});
}

/// Gives the worker a disputed unit that it has not rendered.
bool Scheduler::grant_check(JobState& job, uint32_t slot, WorkerId id, Worker& worker,
                            const MayTry& may_try) {
  FrameState& books = *job.slots[slot].books;
  const auto extent = books.next_check(id, may_try);
  if (!extent) return false;
  books.assign(*extent, {id, {options_.incarnation, next_lease_}}, next_assignment_++);
  --worker.wanted;
  new_lease(id, worker, job, slot, false, {*extent});
  update_ready(job);
  return true;
}

/// Nothing more for the worker and nothing more from it. False where that is so already.
bool Scheduler::quarantine(WorkerId id, const std::string& reason) {
  if (!quarantined_.insert(id).second) return false;
  say(Quarantine{id, reason});
  if (Worker* worker = find_worker(id)) {
    const std::vector<uint64_t> numbers = worker->leases;
    for (const uint64_t number : numbers) release_lease(number, true);
    settle(*worker, std::nullopt);
    if (!std::exchange(worker->barred, true)) count_class(worker->worker_class, -1);
  }
  // A unit that failed with others may now be theirs to try again.
  work_appeared_ = true;
  return true;
}

/// What the worker gave to open frames, where no other agreed, is rendered again. A broken machine
/// may err now and then, so that an earlier unit that was right says nothing of the next. Films
/// from before a restart are nobody's (0), and so may be its own.
void Scheduler::doubt_films_of(WorkerId id) {
  const auto tiles_of = [&](const FrameState& books) {
    std::vector<uint32_t> tiles = books.unverified_tiles(id);
    if (id == WorkerId{}) return tiles;
    const std::vector<uint32_t> nobodys = books.unverified_tiles(WorkerId{});
    tiles.insert(tiles.end(), nobodys.begin(), nobodys.end());
    return tiles;
  };
  for (const auto& [number, job] : jobs_) {
    for (uint32_t i = 0; i < job->slots.size(); ++i) {
      FrameSlot& slot = job->slots[i];
      if (!slot.books) continue;
      const std::vector<uint32_t> tiles = tiles_of(*slot.books);
      if (tiles.empty()) continue;
      mark_disputed(*job);
      if (slot.phase == FramePhase::waiting) {
        restart_waiting(*job, i);
        continue;
      }
      if (job->plan.whole_frames) {
        doubt_frame(*job, slot);
        continue;
      }
      for (const uint32_t tile : tiles) slot.books->doubt_tile(tile);
      void_doubted(*job, slot);
    }
    update_ready(*job);
  }
}

/// Nothing of the frame counts any more. It begins again, at once or after what it waits for.
void Scheduler::doubt_frame(JobState& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::rendering) return restart_frame(job, slot);
  slot.doubted = true;
}

/// Has tiles in doubt voided; of a frame whose outputs are being made when that is over.
void Scheduler::void_doubted(JobState& job, FrameSlot& slot) {
  if (slot.phase != FramePhase::rendering) return;
  for (const uint32_t tile : slot.books->newly_doubted()) {
    persist(TileVoidedRecord{job.id, slot.frame, job.grid.tile(tile)}, {});
  }
}

void Scheduler::tile_voided(const TileVoidedRecord& record) {
  if (!still_wanted(record)) return;
  JobState& job = *find_job(record.job);
  auto batches = job.slot(record.frame)->books->void_tile(*job.grid.index_of(record.tile));
  say(TileVoided{record.job, record.frame, record.tile, std::move(batches)});
  update_ready(job);
  open_frames(job);
}

/// Whether a record that could not be made durable still says something: a tile that has begun
/// again with its frame must not be voided once more, for its films are new.
bool Scheduler::still_wanted(const Record& record) {
  return std::visit(
      core::Overloaded{
          [](const UnitRecord&) { return true; },
          [](const FrameFinishedRecord&) { return true; },
          [](const FrameFailedRecord&) { return true; },
          [](const FrameRestartedRecord&) { return true; },
          [this](const TileVoidedRecord& voided) {
            JobState* job = find_job(voided.job);
            const FrameSlot* slot = job ? job->slot(voided.frame) : nullptr;
            return slot != nullptr && slot->phase == FramePhase::rendering &&
                   slot->books->in_doubt(*job->grid.index_of(voided.tile));
          },
          [this](const DisputeRecord& dispute) { return find_job(dispute.job) != nullptr; },
          [](const WorkerOddRecord&) { return true; },
      },
      record);
}

/// The job's log says that its films may be wrong, until end_marks(): should the coordinator die
/// before all that is wrong is void, the next one renders again what it cannot tell apart.
void Scheduler::mark_disputed(JobState& job) {
  if (job.mark != DisputeMark::none) return;
  job.mark = DisputeMark::opening;
  marked_.insert(job.id);
  persist(DisputeRecord{job.id, true}, {});
}

void Scheduler::dispute_marked(JobState& job, bool open) {
  job.mark = open ? DisputeMark::open : DisputeMark::none;
  if (open) return;
  marked_.erase(job.id);
  // Another one may have begun meanwhile.
  if (has_dispute(job) || any_in_doubt()) mark_disputed(job);
}

bool Scheduler::has_dispute(const JobState& job) {
  return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
    return job.slots[i].books && job.slots[i].books->disputes() > 0;
  });
}

/// Whether films are to be void, in whatever job, and that is not durable yet.
bool Scheduler::any_in_doubt() const {
  return std::any_of(jobs_.begin(), jobs_.end(), [](const auto& entry) {
    const JobState& job = *entry.second;
    return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
      const FrameSlot& slot = job.slots[i];
      // Without books it fails or begins again, and its films with it.
      return slot.books ? slot.books->any_doubted() || job.begins_again(slot) : slot.in_flight();
    });
  });
}

/// Disputes that are over, and all that followed from them.
void Scheduler::end_marks() {
  if (odd_records_ > 0) return;
  for (const JobId id : marked_) {
    JobState& job = *find_job(id);
    if (job.mark != DisputeMark::open || has_dispute(job) || any_in_doubt()) continue;
    job.mark = DisputeMark::ending;
    persist(DisputeRecord{id, false}, {});
  }
}

/// A conflict showed while the outputs were made: the frame goes on until it is settled.
void Scheduler::reopen_frame(JobState& job, FrameSlot& slot) {
  slot.phase = FramePhase::rendering;
  slot.doubted = false;
  say(FrameReopened{job.id, slot.frame});
  void_doubted(job, slot);
  update_ready(job);
}

}  // namespace hyades::coordinator
