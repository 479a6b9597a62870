#include "coordinator/scheduler/conflicts.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// With so many different answers it is not the machines: the unit is no pure function.
constexpr size_t kMostAnswers = 5;

/// Where it took a look at more jobs and frames than that, the next one is not with the next event.
constexpr size_t kManyFrames = 1000;
constexpr Duration kRest = std::chrono::milliseconds(100);

/// How many witnesses there are among those opinions that `counts`.
template <class Counts>
size_t witnesses(const std::vector<Opinion>& opinions, Counts counts) {
  std::set<Witness> heard;
  for (const Opinion& o : opinions) {
    if (counts(o)) heard.insert(o.witness);
  }
  return heard.size();
}

}  // namespace

bool Conflicts::weigh(ScheduledJob& job, FrameSlot& slot, const Extent& extent, Witness witness,
                      const ResultArrived& e) {
  FrameLedger& ledger = *slot.ledger;
  const HeldRecord held = *ledger.find_held(extent);
  Dispute* dispute = ledger.find_dispute(extent);
  if (dispute == nullptr) {
    if (held.digest == e.digest) {
      // Who sends the same again, under whatever name, agrees with nobody, and who it was before a
      // restart is not known.
      if (held.worker != WorkerId{} && held.witness != witness) {
        ledger.verify(extent);
        confirm(job, slot, held.worker);
        confirm(job, slot, e.worker);
      }
      return false;
    }
    dispute = &ledger.open_dispute(extent, {held.worker, held.digest, held.witness});
  }
  if (held.digest != e.digest) {
    dispute->differs = true;
    mark_disputed(job);
  }
  std::vector<Opinion>& opinions = dispute->opinions;
  if (std::none_of(opinions.begin(), opinions.end(),
                   [&](const Opinion& o) { return o.worker == e.worker; })) {
    if (held.digest != e.digest) step_.say(Conflict{e.job, e.unit, held.worker, e.worker});
    opinions.push_back({e.worker, e.digest, witness});
    const size_t agree = witnesses(
        opinions, [&](const Opinion& o) { return o.worker != WorkerId{} && o.digest == e.digest; });
    if (agree > 1) {
      decide(job, slot, Dispute(*dispute), e);
      return held.digest != e.digest;
    }
    if (witnesses(opinions, [](const Opinion&) { return true; }) >= kMostAnswers) {
      const core::PixelRect tile = job.grid.tile(extent.tile);
      frames_.fail_or_leave(
          job, slot, e.worker,
          fmt::format("{} workers rendered tile {},{} batches {}-{} to {} different films",
                      kMostAnswers, tile.x0, tile.y0, extent.batches.first,
                      extent.batches.end() - 1, kMostAnswers));
      return false;
    }
  }
  jobs_.update_offer(job);
  return false;
}

/// Two witnesses agree, of which that of `e` is the second: the others are wrong.
void Conflicts::decide(ScheduledJob& job, FrameSlot& slot, const Dispute& dispute,
                       const ResultArrived& e) {
  FrameLedger& ledger = *slot.ledger;
  const Extent extent = dispute.extent;
  leases_.end_assignment(job, slot, extent, e.lease);
  if (ledger.waits_for_checks()) step_.work_appeared = true;
  ledger.end_dispute(extent);
  const bool right = ledger.find_held(extent)->digest == e.digest;
  if (right) {
    ledger.verify(extent);
  } else if (job.plan.whole_frames) {
    suspect_frame(job, slot);  // and its ledger with it
  } else {
    ledger.suspect_tile(extent.tile);
  }
  for (const Opinion& o : dispute.opinions) {
    if (o.digest == e.digest) {
      confirm(job, slot, o.worker);
      continue;
    }
    suspect_films_of(o.worker);
    if (o.worker == WorkerId{}) continue;
    const std::string reason = fmt::format(
        "rendered job {} frame {} tile {},{} batches {}-{} to other bits than two "
        "other workers",
        static_cast<uint64_t>(job.id), slot.frame, e.unit.tile.x0, e.unit.tile.y0,
        extent.batches.first, extent.batches.end() - 1);
    workers_.quarantine(o.worker, reason);
    ++divergent_records_;
    records_.persist(DivergentWorkerRecord{job.id, slot.frame, o.worker, reason});
  }
  frames_.void_suspect_tiles(job, slot);
  jobs_.update_offer(job);
  frames_.finish_if_complete(job, slot);
}

/// The worker could be trusted when it rendered a unit of this frame.
void Conflicts::confirm(const ScheduledJob& job, const FrameSlot& slot, WorkerId worker) {
  if (worker != WorkerId{}) step_.say(Confirmed{worker, job.id, slot.frame});
}

void Conflicts::restored(ScheduledJob& job, bool disputed) {
  if (disputed) {
    // Nobody knows any more who was divergent, and what else it did.
    distrust_restored_ = true;
    job.mark = DisputeMark::open;
    marked_.insert(job.id);
  }
  if (distrust_restored_) suspect_films_of(WorkerId{});
}

/// What the worker gave to open frames, where no other agreed, is rendered again. A broken machine
/// may err now and then, so that an earlier unit that was right says nothing of the next. Films
/// from before a restart are nobody's (0), and so may be its own.
void Conflicts::suspect_films_of(WorkerId id) {
  const auto tiles_of = [&](const FrameLedger& ledger) {
    std::vector<uint32_t> tiles = ledger.unverified_tiles(id);
    if (id == WorkerId{}) return tiles;
    const std::vector<uint32_t> nobodys = ledger.unverified_tiles(WorkerId{});
    tiles.insert(tiles.end(), nobodys.begin(), nobodys.end());
    return tiles;
  };
  for (const auto& [number, job] : jobs_.all()) {
    for (FrameSlot& slot : job->slots) {
      if (!slot.ledger) continue;
      const std::vector<uint32_t> tiles = tiles_of(*slot.ledger);
      if (tiles.empty()) continue;
      mark_disputed(*job);
      if (slot.phase == FramePhase::waiting) {
        frames_.bring_back(*job, slot);
        continue;
      }
      if (job->plan.whole_frames) {
        suspect_frame(*job, slot);
        continue;
      }
      for (const uint32_t tile : tiles) slot.ledger->suspect_tile(tile);
      frames_.void_suspect_tiles(*job, slot);
    }
    jobs_.update_offer(*job);
  }
}

/// Nothing of the frame counts any more. It begins again, at once or after what it waits for.
void Conflicts::suspect_frame(ScheduledJob& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::rendering) return frames_.restart(job, slot);
  slot.suspect = true;
}

void Conflicts::persisted(const TileVoidedRecord& record) {
  if (!still_wanted(record)) return;
  const auto [job, slot] = jobs_.find_frame({record.job, record.frame});
  const uint32_t tile = *job->grid.index_of(record.tile);
  FrameLedger& ledger = *slot->ledger;
  // What these are for was found by films that are void.
  for (const Extent& e : ledger.assigned_beyond_first_round(tile)) {
    leases_.end_assignment(*job, *slot, e, {});
  }
  const uint32_t spared = ledger.spared(tile);
  step_.say(TileVoided{record.job, record.frame, record.tile, ledger.void_tile(tile), spared});
  jobs_.update_offer(*job);
  frames_.open(*job);
}

bool Conflicts::still_wanted(const Record& record) const {
  const auto* voided = std::get_if<TileVoidedRecord>(&record);
  return voided == nullptr || still_wanted(*voided);
}

bool Conflicts::still_wanted(const TileVoidedRecord& record) const {
  const auto [job, slot] = jobs_.find_frame({record.job, record.frame});
  return slot->phase == FramePhase::rendering &&
         slot->ledger->is_suspect(*job->grid.index_of(record.tile));
}

/// The job's log says that its films may be wrong, until end_marks(): should the coordinator die
/// before all that is wrong is void, the next one renders again what it cannot tell apart.
void Conflicts::mark_disputed(ScheduledJob& job) {
  if (job.mark != DisputeMark::none) return;
  job.mark = DisputeMark::opening;
  marked_.insert(job.id);
  records_.persist(DisputeRecord{job.id, true});
}

void Conflicts::persisted(const DisputeRecord& record) {
  ScheduledJob& job = *jobs_.find(record.job);
  job.mark = record.open ? DisputeMark::open : DisputeMark::none;
  if (record.open) return;
  marked_.erase(job.id);
  // Another one may have begun meanwhile.
  if (has_dispute(job) || any_suspect()) mark_disputed(job);
}

void Conflicts::persisted(const DivergentWorkerRecord&) { --divergent_records_; }

bool Conflicts::has_dispute(const ScheduledJob& job) {
  return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
    return job.slots[i].ledger && job.slots[i].ledger->disputes() > 0;
  });
}

/// Whether films are to be void, in whatever job, and that is not durable yet.
bool Conflicts::any_suspect() {
  size_t looked = 0;
  const bool any = std::any_of(jobs_.all().begin(), jobs_.all().end(), [&](const auto& entry) {
    const ScheduledJob& job = *entry.second;
    looked += 1 + job.in_flight.size();
    return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
      const FrameSlot& slot = job.slots[i];
      // Without a ledger it fails or begins again, and its films with it.
      return slot.ledger ? slot.ledger->any_suspect() || job.begins_again(slot) : slot.in_flight();
    });
  });
  if (looked > kManyFrames) next_look_ = step_.now + kRest;
  return any;
}

std::optional<TimePoint> Conflicts::next_wake() const {
  return marked_.empty() || step_.now >= next_look_ ? std::nullopt : std::optional(next_look_);
}

void Conflicts::end_marks() {
  if (divergent_records_ > 0) return;
  if (marked_.empty() || step_.now < next_look_) return;
  std::erase_if(marked_, [this](JobId id) { return jobs_.find(id) == nullptr; });
  if (marked_.empty() || any_suspect()) return;
  for (const JobId id : marked_) {
    ScheduledJob& job = *jobs_.find(id);
    if (job.mark != DisputeMark::open || has_dispute(job)) continue;
    job.mark = DisputeMark::ending;
    records_.persist(DisputeRecord{id, false});
  }
}

}  // namespace hyades::coordinator
