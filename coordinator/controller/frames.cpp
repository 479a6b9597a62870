// What becomes of frames.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "farm/wire.h"

namespace hyades::coordinator {

/// On the film store's thread, as the film is at hand there.
void Controller::merged(JobId job, const Merge& merge) {
  FilmStore* film_store = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (ActiveJob* active = active_job(job)) film_store = active->film_store.get();
  }
  if (film_store == nullptr) return;
  const int64_t begun_us = wall_us();
  const core::Status status = film_store->merge(merge.record);
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  if (!status) {
    // Checked when it arrived: this is a bug, and better a stuck frame than a wrong one.
    note(*active, v1::LOG_LEVEL_ERROR, merge.unit.frame, {},
         "a film cannot be merged: " + status.error().message);
    return;
  }
  const uint64_t samples = samples_of(*active, merge.unit.tile, merge.unit.batches);
  active->touch(merge.unit.frame).samples_done += samples;
  active->samples_done += samples;
  count_film(*active, merge, begun_us);
}

uint64_t Controller::samples_of(const ActiveJob& active, const core::PixelRect& tile,
                                const core::BatchRange& batches) const {
  return core::samples_in(tile, batches, active.read.job.sampling.samples);
}

/// The film store has taken the tile out of the film.
void Controller::tile_voided(const TileVoided& voided) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(voided.job);
  if (active == nullptr) return;
  uint64_t samples = 0;
  for (const core::BatchRange& batches : voided.batches) {
    samples += samples_of(*active, voided.tile, batches);
  }
  FrameNote& frame = active->touch(voided.frame);
  samples = std::min(samples, frame.samples_done);
  frame.samples_done -= samples;
  active->samples_done -= samples;
  note(*active, v1::LOG_LEVEL_WARNING, voided.frame, {},
       fmt::format("tile {},{} is rendered again: a quarantined worker had a part in it",
                   voided.tile.x0, voided.tile.y0));
}

/// What the finisher has made is of a film in doubt.
void Controller::frame_reopened(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  active->complete.erase(frame);
  active->touch(frame).state = v1::FRAME_STATE_RENDERING;
  note(*active, v1::LOG_LEVEL_WARNING, frame, {},
       "is not done: a unit that was rendered differently twice is rendered once more");
  // Should this be lost, or come after the frame is done again, it is rendered again or stays.
  background_.add(static_cast<uint64_t>(job), [this, id = static_cast<uint64_t>(job), frame] {
    (void)store_->forget_frame(id, frame);
    return true;
  });
}

/// On the film store's thread, unless the film is among the complete ones already.
void Controller::finish_frame(const FinishFrame& finish) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(finish.job);
  if (active == nullptr) return;
  auto& film = active->complete[finish.frame];
  if (!film) film = active->film_store->film(finish.frame);
  active->touch(finish.frame).state = v1::FRAME_STATE_FINISHING;
  to_finish_.push_back({finish.job, finish.frame, film, names_of(finish.unconfirmed)});
  finish_wake_.notify_one();
}

void Controller::frame_done(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  active->film_store->forget(frame, true);
  active->complete.erase(frame);
  active->touch(frame).state = v1::FRAME_STATE_DONE;
  active->in_work.erase(frame);
  active->stored.preview = frame;
  ++active->stored.frames_done;
  note(*active, v1::LOG_LEVEL_INFO, frame, {}, "done");
}

void Controller::frame_failed(JobId job, int32_t frame, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  active->film_store->forget(frame, false);
  active->complete.erase(frame);
  FrameNote& noted = active->touch(frame);
  noted.state = v1::FRAME_STATE_FAILED;
  active->in_work.erase(frame);
  noted.reason = farm::wire_text(reason);
  active->samples_done -= std::exchange(noted.samples_done, 0);
  ++active->stored.frames_failed;
  note(*active, v1::LOG_LEVEL_ERROR, frame, {}, "failed: " + reason);
}

void Controller::frame_restarted(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  FrameNote& noted = active->touch(frame);
  if (noted.state == v1::FRAME_STATE_FAILED) --active->stored.frames_failed;
  if (noted.state == v1::FRAME_STATE_DONE) --active->stored.frames_done;
  active->complete.erase(frame);
  noted.state = v1::FRAME_STATE_WAITING;
  active->in_work.erase(frame);
  noted.reason.clear();
  noted.worker_class.clear();
  ++noted.restarts;
  active->samples_done -= std::exchange(noted.samples_done, 0);
  note(*active, v1::LOG_LEVEL_WARNING, frame, {}, "is rendered again from its beginning");
}

void Controller::persisted(JobId job, RecordId record) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    if (ActiveJob* active = active_job(job); active != nullptr && !active->trouble.empty()) {
      active->trouble.clear();
      active->touch();
    }
    later = tell(Persisted{record});
  }
  carry_out(later);
}

void Controller::not_persisted(JobId job, RecordId record, const std::string& reason) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    if (ActiveJob* active = active_job(job)) {
      active->films_under_way.erase(record);
      active->trouble = "films cannot be stored: " + reason;
      active->touch();
    }
    later = tell(PersistFailed{record, reason});
  }
  carry_out(later);
}

void Controller::storage_failed(JobId job, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (ActiveJob* active = active_job(job)) {
    active->trouble = "films cannot be stored: " + reason;
    active->touch();
    note(*active, v1::LOG_LEVEL_ERROR, std::nullopt, {}, active->trouble);
  }
}

}  // namespace hyades::coordinator
