// What is durable, and the films that are made of it.
#include "core/base/overloaded.h"
#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

uint64_t SimulatedWorld::value_of(int32_t frame, const core::PixelRect& tile, uint32_t batch) {
  uint64_t h = core::hash_combine(static_cast<uint64_t>(frame), batch);
  h = core::hash_combine(h, static_cast<uint64_t>(tile.x0) << 32U | uint32_t(tile.y0));
  return core::hash_combine(h, static_cast<uint64_t>(tile.x1) << 32U | uint32_t(tile.y1));
}

void SimulatedWorld::add_to_film(SimJob& job, const AcceptedUnit& accepted, uint64_t generation) {
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

void SimulatedWorld::act(const Persist& a) {
  if (const auto* unit = std::get_if<UnitRecord>(&a.record)) {
    records_[a.id] = unit->accepted;
    unsettled_.insert({unit->job, a.id});
  }
  if (const auto* again = std::get_if<FrameRestartedRecord>(&a.record)) {
    jobs_.at(again->job).rows.erase(again->frame);
  }
  // What failed, and who is divergent, is not in the film log.
  if (real_store_ && !std::holds_alternative<FrameFailedRecord>(a.record) &&
      !std::holds_alternative<DivergentWorkerRecord>(a.record)) {
    return append(jobs_.at(frame_of(a.record).first), a);
  }
  ++storing_[frame_of(a.record)];
  store_later(a);
}

std::pair<JobId, int32_t> SimulatedWorld::frame_of(const Record& record) {
  using Place = std::pair<JobId, int32_t>;
  return std::visit(core::Overloaded{
                        [](const UnitRecord& r) { return Place(r.job, r.accepted.unit.frame); },
                        [](const FrameFinishedRecord& r) { return Place(r.job, r.frame); },
                        [](const FrameFailedRecord& r) { return Place(r.job, r.failed.frame); },
                        [](const FrameRestartedRecord& r) { return Place(r.job, r.frame); },
                        [](const TileVoidedRecord& r) { return Place(r.job, r.frame); },
                        [](const DisputeRecord& r) { return Place(r.job, INT32_MIN); },
                        [](const DivergentWorkerRecord& r) { return Place(r.job, INT32_MIN); },
                    },
                    record);
}

void SimulatedWorld::store_later(const Persist& a) {
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
      // That a frame has failed its film store hears first.
      if (!std::holds_alternative<FrameFailedRecord>(a.record)) return stored(a, refuse);
      call(jobs_.at(frame_of(a.record).first), [this, a, refuse] { stored(a, refuse); });
    });
  });
}

void SimulatedWorld::stored(const Persist& a, bool refused) {
  --storing_[frame_of(a.record)];
  unsettled_.erase({frame_of(a.record).first, a.id});
  if (refused) {
    tell(PersistFailed{a.id, "disk full"});
  } else {
    tell(Persisted{a.id});
  }
}

/// Whether a film of the tile is still on its way to the disk, or was said to be and nobody knows
/// yet that it has arrived.
bool SimulatedWorld::stores_unit_of(const TileVoidedRecord& voided) const {
  for (const auto& [id, accepted] : records_) {
    if (accepted.unit.frame == voided.frame && accepted.unit.tile == voided.tile &&
        unsettled_.contains({voided.job, id})) {
      return true;
    }
  }
  return false;
}

void SimulatedWorld::store(const Record& record) {
  std::visit([this](const auto& r) { store(r); }, record);
}

void SimulatedWorld::store(const UnitRecord& unit) {
  SimJob& job = jobs_.at(unit.job);
  job.stored.accepted.push_back(unit.accepted);
  if (!job.stored_units.insert(name(unit.accepted.unit)).second) fail("a unit is stored twice");
}

void SimulatedWorld::store(const FrameFinishedRecord& done) {
  jobs_.at(done.job).stored.finished.push_back(done.frame);
}

void SimulatedWorld::store(const FrameFailedRecord& failed) {
  jobs_.at(failed.job).stored.failed.push_back(failed.failed.frame);
}

void SimulatedWorld::store(const FrameRestartedRecord& again) {
  SimJob& job = jobs_.at(again.job);
  std::erase(job.stored.finished, again.frame);
  std::erase(job.stored.failed, again.frame);
  std::erase_if(job.stored.accepted,
                [&](const AcceptedUnit& u) { return u.unit.frame == again.frame; });
  std::erase_if(job.stored_units, [&](const UnitName& u) { return std::get<0>(u) == again.frame; });
  std::erase_if(job.disagreed, [&](const core::Unit& u) { return u.frame == again.frame; });
}

void SimulatedWorld::store(const TileVoidedRecord& voided) {
  SimJob& job = jobs_.at(voided.job);
  if (real_store_ && !job.ended) {
    SimFrame& frame = job.frames.at(voided.frame);
    if (job.disk->is_aside(voided.frame)) {
      ++aside.voids;
      frame.digest = job.disk->void_aside(voided);
    } else {
      frame.film.erase(voided.tile);
    }
  }
  std::erase_if(job.stored.accepted, [&](const AcceptedUnit& u) {
    const bool there = u.unit.frame == voided.frame && u.unit.tile == voided.tile;
    if (there) job.stored_units.erase(name(u.unit));
    return there;
  });
  std::erase_if(job.disagreed, [&](const core::Unit& u) {
    return u.frame == voided.frame && u.tile == voided.tile;
  });
}

void SimulatedWorld::store(const DisputeRecord& dispute) {
  jobs_.at(dispute.job).stored.disputed = dispute.open;
}

void SimulatedWorld::act(const Merge& a) {
  if (!is_stored(a.job, a.unit)) fail("a film is merged that is not durable");
  if (frame_of(a.job, a.unit.frame).over) fail("a film is merged into a frame that is over");
  const AcceptedUnit& accepted = records_.at(a.record);
  const bool portable = jobs_.at(a.job).plan.needs.render_class == core::RenderClass::portable;
  if ((accepted.worker_class == kPortable) != portable) fail("a film is of another kind of class");
  add_to_film(jobs_.at(a.job), accepted, generation_ + 1);
  if (!real_store_) return;
  SimFrame& frame = frame_of(a.job, a.unit.frame);
  if (frame.lost) fail("a film is merged with one that is lost");
  frame.worker_class = accepted.worker_class;
  if (!fetch(jobs_.at(a.job), a.unit.frame)) return;
  frame.in_memory = true;
  const core::Status merged =
      frame.film.merge(jobs_.at(a.job).disk->film_of(accepted.unit, accepted.digest[1]));
  if (!merged) fail("a film cannot be merged: " + merged.error().message);
}

/// By the store, when what it was handed before is merged. It may take its time, and die meanwhile.
void SimulatedWorld::act(const JudgeTile& a) {
  ++tiles_judged;
  SimJob& job = jobs_.at(a.job);
  std::set<uint32_t> there;
  bool wrong = false;
  for (const auto& [place, batch] : job.frames.at(a.frame).batches) {
    if (std::get<0>(place) == a.tile.x0 && std::get<1>(place) == a.tile.y0) {
      there.insert(std::get<2>(place));
      wrong = wrong || batch.corrupted_by != 0;
    }
  }
  if (there.size() != a.batches || *there.rbegin() + 1 != a.batches) {
    fail("a tile is judged by other batches than those planned");
  }
  const TileJudged judged{a.job, a.frame, a.tile, a.serial,
                          job.is_enough(a.frame, a.tile, a.batches, wrong)};
  call(job, [this, judged, &job] {
    if (!real_store_ || fetch(job, judged.frame)) tell_later(judged);
  });
}

void SimulatedWorld::act(const FrameRestarted& a) {
  ++frames_restarted;
  SimFrame& frame = frame_of(a.job, a.frame);
  frame.batches.clear();
  frame.sum = 0;
  frame.over = false;
  frame.lost = false;
  if (!real_store_) return;
  forget_film(jobs_.at(a.job), frame, a.frame);
  frame.film = jobs_.at(a.job).disk->blank();
}

void SimulatedWorld::act(const TileVoided& a) {
  ++tiles_voided;
  SimFrame& frame = frame_of(a.job, a.frame);
  if (frame.over) fail("a tile of a frame that is over is voided");
  if (jobs_.at(a.job).plan.whole_frames) fail("a tile is voided that cannot be taken out");
  std::erase_if(frame.batches, [&](const auto& entry) {
    const auto& [place, batch] = entry;
    if (std::get<0>(place) != a.tile.x0 || std::get<1>(place) != a.tile.y0) return false;
    frame.sum -= batch.value;
    return true;
  });
}

}  // namespace hyades::coordinator
