// What the coordinator says of frames and jobs, held against what may be.
#include <algorithm>

#include "coordinator/scheduler/tile_grid.h"
#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

void SimulatedWorld::act(const OpenFrame& a) {
  if (frame_of(a.job, a.frame).over) fail("a frame that is over is opened");
  if (frame_of(a.job, a.frame).refused) {
    tell_later(FrameRefused{a.job, a.frame, "refused"});
  } else {
    tell_later(FrameOpened{a.job, a.frame});
  }
}

core::Film SimulatedWorld::oracle_of(const SimJob& job, int32_t number) {
  if (job.plan.rounds.empty()) return job.disk->oracle(number);
  core::Film film = job.disk->blank();
  const TileGrid grid(job.plan.region, job.plan.tile_size);
  for (uint32_t t = 0; t < grid.size(); ++t) {
    const core::PixelRect tile = grid.tile(t);
    (void)film.merge(job.disk->film_of({number, tile, {0, job.batches_of(number, tile)}}, 0));
  }
  return film;
}

void SimulatedWorld::act(const FinishFrame& a) {
  SimJob& job = jobs_.at(a.job);
  SimFrame& frame = job.frames.at(a.frame);
  const TileGrid grid(job.plan.region, job.plan.tile_size);
  uint64_t oracle = 0;
  uint64_t volume = 0;
  for (uint32_t t = 0; t < grid.size(); ++t) {
    const uint32_t batches = job.batches_of(a.frame, grid.tile(t));
    volume += batches * static_cast<uint64_t>(grid.tile(t).area());
    for (uint32_t b = 0; b < batches; ++b) oracle += value_of(a.frame, grid.tile(t), b);
  }
  bool wrong = false;
  SimRow row{a.unconfirmed, {}};
  for (const auto& [place, batch] : frame.batches) {
    if (batch.corrupted_by == 0) continue;
    wrong = true;
    row.corrupted_by.insert(batch.corrupted_by);
    // It may never have been compared. What a job that is not there yet tells of it opens the frame
    // again.
    if (!restoring_ && workers_[batch.corrupted_by - 1U].quarantined_by != 0) {
      fail("a film is finished with what a worker did that had been found out");
    }
    for (const core::Unit& unit : job.disagreed) {
      if (unit.frame == a.frame &&
          place == PlaceOfBatch{unit.tile.x0, unit.tile.y0, std::get<2>(place)} &&
          std::get<2>(place) >= unit.batches.first && std::get<2>(place) < unit.batches.end()) {
        fail("a film is finished that two workers had disagreed about");
      }
    }
  }
  if (!wrong && a.volume != volume) fail("a frame is finished with other batches than it needs");
  frames_wrong += wrong;
  if (!wrong && frame.sum != oracle) fail("a film is finished that is not the frame's");
  call(job, [this, a, wrong, row, &job, &frame] {
    if (real_store_ && !fetch(job, a.frame)) return;
    if (frame.lost || frame.over) return;  // it has failed meanwhile
    if (real_store_ && !wrong && frame.film.digest() != oracle_of(job, a.frame).digest()) {
      fail("a film is finished whose bits are not the frame's");
    }
    if (frame.unfinishable || fault()) {
      return tell_later(FinishFailed{a.job, a.frame, "no room for a picture"});
    }
    after(delay(), [this, a, row, g = generation_] {
      if (g != generation_ || jobs_.at(a.job).ended) return;
      jobs_.at(a.job).rows[a.frame] = row;
      tell_later(FinishDone{a.job, a.frame});
    });
  });
}

void SimulatedWorld::act(const FrameDone& a) {
  ++frames_done;
  SimFrame& frame = frame_of(a.job, a.frame);
  if (frame.over) fail("a frame is over twice");
  if (frame.poisoned || frame.refused || frame.unfinishable) fail("a hopeless frame is done");
  if (frame.lost) fail("a frame is done whose film is lost");
  frame.over = true;
  forget_film(jobs_.at(a.job), frame, a.frame);
}

void SimulatedWorld::act(const FrameFailed& a) {
  ++frames_failed;
  SimFrame& frame = frame_of(a.job, a.frame);
  if (frame.over) fail("a frame is over twice");
  if (!frame.poisoned && !frame.refused && !frame.unfinishable &&
      a.reason != "no room for a picture" && !broken_ && !frame.lost) {
    fail("a good frame failed: " + a.reason);
  }
  frame.over = true;
  forget_film(jobs_.at(a.job), frame, a.frame);
}

void SimulatedWorld::act(const JobEnded& a) {
  SimJob& job = jobs_.at(a.job);
  if (job.ended) fail("a job ends twice");
  if (a.cancelled != job.cancelled) fail("a job is cancelled that nobody cancelled");
  if (!a.cancelled && a.done + a.failed != job.plan.frames.size()) fail("frames are missing");
  job.ended = true;
  for (auto& [number, frame] : job.frames) forget_film(job, frame, number);
}

void SimulatedWorld::act(const Conflict&) {
  ++conflicts;
  if (!corrupt_) fail("a conflict between equal films");
}

void SimulatedWorld::act(const Quarantine& a) {
  SimWorker& w = workers_[index_of(a.worker)];
  if (a.reason.starts_with("failed ")) {
    ++struck_out;
    // Bad luck can do it, too; then somebody releases it.
    if (!w.broken) {
      after(std::chrono::seconds(number(1, 20)), [this, id = a.worker] {
        tell(WorkerBarred{id, false});
      });
    }
    return;
  }
  ++quarantines;
  if (!w.corrupt) fail("a good worker is quarantined");
  w.quarantined_by = generation_ + 1;
}

void SimulatedWorld::act(const FrameReopened& a) {
  ++frames_reopened;
  jobs_.at(a.job).rows.erase(a.frame);
}

/// The worker is divergent, and that is durable: so is the suspicion of what it had a part in.
void SimulatedWorld::store(const DivergentWorkerRecord& divergent) {
  workers_[index_of(divergent.worker)].known_divergent = true;
  for (auto& [id, job] : jobs_) {
    FramesSuspected suspected{id, {}};
    for (auto& [frame, row] : job.rows) {
      const auto& by = row.unconfirmed;
      if (std::find(by.begin(), by.end(), divergent.worker) == by.end() &&
          std::find(by.begin(), by.end(), WorkerId{}) == by.end()) {
        continue;
      }
      row.suspect = true;
      suspected.frames.push_back(frame);
    }
    if (suspected.frames.empty() || job.ended) continue;
    frames_suspected += suspected.frames.size();
    tell_later(suspected);
  }
}

/// All jobs have ended: whatever shows what a divergent worker did must be known to be suspect.
void SimulatedWorld::check_rows() {
  for (const auto& [id, job] : jobs_) {
    for (const auto& [frame, row] : job.rows) {
      left_suspect += row.suspect;
      for (const uint8_t by : row.corrupted_by) {
        if (workers_[by - 1U].known_divergent && !row.suspect) {
          fail("outputs show what a divergent worker did, and nobody knows");
        }
      }
    }
  }
}

}  // namespace hyades::coordinator
