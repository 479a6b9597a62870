// What becomes of frames.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "farm/wire.h"

namespace hyades::coordinator {

/// On the film store's thread, as the film is at hand there.
void Brain::merged(JobId job, const Merge& merge) {
  FilmStore* film_store = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (JobDesk* desk = desk_of(job)) film_store = desk->film_store.get();
  }
  if (film_store == nullptr) return;
  const int64_t begun_us = wall_us();
  const core::Status status = film_store->merge(merge.record);
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(job);
  if (desk == nullptr) return;
  if (!status) {
    // Checked when it arrived: this is a bug, and better a stuck frame than a wrong one.
    note(*desk, v1::LOG_LEVEL_ERROR, merge.unit.frame, {},
         "a film cannot be merged: " + status.error().message);
    return;
  }
  const uint64_t samples = samples_of(*desk, merge.unit.tile, merge.unit.batches);
  desk->touch(merge.unit.frame).samples_done += samples;
  desk->samples_done += samples;
  count_film(*desk, merge, begun_us);
}

uint64_t Brain::samples_of(const JobDesk& desk, const core::PixelRect& tile,
                           const core::BatchRange& batches) const {
  return core::samples_in(tile, batches, desk.read.job.sampling.samples);
}

/// The film store has taken the tile out of the film.
void Brain::tile_voided(const TileVoided& voided) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(voided.job);
  if (desk == nullptr) return;
  uint64_t samples = 0;
  for (const core::BatchRange& batches : voided.batches) {
    samples += samples_of(*desk, voided.tile, batches);
  }
  FrameNote& frame = desk->touch(voided.frame);
  samples = std::min(samples, frame.samples_done);
  frame.samples_done -= samples;
  desk->samples_done -= samples;
  note(*desk, v1::LOG_LEVEL_WARNING, voided.frame, {},
       fmt::format("tile {},{} is rendered again: a quarantined worker had a part in it",
                   voided.tile.x0, voided.tile.y0));
}

/// What the finisher has made is of a film in doubt.
void Brain::frame_reopened(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(job);
  if (desk == nullptr) return;
  desk->complete.erase(frame);
  desk->touch(frame).state = v1::FRAME_STATE_RENDERING;
  note(*desk, v1::LOG_LEVEL_WARNING, frame, {},
       "is not done: a unit that was rendered differently twice is rendered once more");
  // Should this be lost, or come after the frame is done again, it is rendered again or stays.
  chores_.add(static_cast<uint64_t>(job), [this, id = static_cast<uint64_t>(job), frame] {
    (void)store_->forget_frame(id, frame);
    return true;
  });
}

/// On the film store's thread, unless the film is among the complete ones already.
void Brain::finish_frame(const FinishFrame& finish) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(finish.job);
  if (desk == nullptr) return;
  auto& film = desk->complete[finish.frame];
  if (!film) film = desk->film_store->film(finish.frame);
  desk->touch(finish.frame).state = v1::FRAME_STATE_FINISHING;
  to_finish_.push_back({finish.job, finish.frame, film, names_of(finish.unconfirmed)});
  finish_wake_.notify_one();
}

void Brain::frame_done(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(job);
  if (desk == nullptr) return;
  desk->film_store->forget(frame, true);
  desk->complete.erase(frame);
  desk->touch(frame).state = v1::FRAME_STATE_DONE;
  desk->in_work.erase(frame);
  desk->stored.preview = frame;
  ++desk->stored.frames_done;
  note(*desk, v1::LOG_LEVEL_INFO, frame, {}, "done");
}

void Brain::frame_failed(JobId job, int32_t frame, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(job);
  if (desk == nullptr) return;
  desk->film_store->forget(frame, false);
  desk->complete.erase(frame);
  FrameNote& noted = desk->touch(frame);
  noted.state = v1::FRAME_STATE_FAILED;
  desk->in_work.erase(frame);
  noted.reason = farm::wire_text(reason);
  desk->samples_done -= std::exchange(noted.samples_done, 0);
  ++desk->stored.frames_failed;
  note(*desk, v1::LOG_LEVEL_ERROR, frame, {}, "failed: " + reason);
}

void Brain::frame_restarted(JobId job, int32_t frame) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(job);
  if (desk == nullptr) return;
  FrameNote& noted = desk->touch(frame);
  if (noted.state == v1::FRAME_STATE_FAILED) --desk->stored.frames_failed;
  if (noted.state == v1::FRAME_STATE_DONE) --desk->stored.frames_done;
  desk->complete.erase(frame);
  noted.state = v1::FRAME_STATE_WAITING;
  desk->in_work.erase(frame);
  noted.reason.clear();
  noted.worker_class.clear();
  ++noted.restarts;
  desk->samples_done -= std::exchange(noted.samples_done, 0);
  note(*desk, v1::LOG_LEVEL_WARNING, frame, {}, "is rendered again from its beginning");
}

void Brain::persisted(JobId job, RecordId record) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    if (JobDesk* desk = desk_of(job); desk != nullptr && !desk->trouble.empty()) {
      desk->trouble.clear();
      desk->touch();
    }
    later = tell(Persisted{record});
  }
  carry_out(later);
}

void Brain::not_persisted(JobId job, RecordId record, const std::string& reason) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    if (JobDesk* desk = desk_of(job)) {
      desk->films_under_way.erase(record);
      desk->trouble = "films cannot be stored: " + reason;
      desk->touch();
    }
    later = tell(PersistFailed{record, reason});
  }
  carry_out(later);
}

void Brain::storage_failed(JobId job, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (JobDesk* desk = desk_of(job)) {
    desk->trouble = "films cannot be stored: " + reason;
    desk->touch();
    note(*desk, v1::LOG_LEVEL_ERROR, std::nullopt, {}, desk->trouble);
  }
}

}  // namespace hyades::coordinator
