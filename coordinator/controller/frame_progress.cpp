#include "coordinator/controller/frame_progress.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/frame_finisher.h"
#include "coordinator/meters/meters.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// How often the noise of a job's films is measured, at most: it takes a millisecond.
constexpr auto kNoiseEvery = std::chrono::seconds(1);

uint64_t samples_of(const ActiveJob& active, const core::PixelRect& tile,
                    const core::BatchRange& batches) {
  return core::samples_in(tile, batches, active.samples);
}

/// "done in 12.3 s, 45.6 s of threads"; of a frame begun before the last start, that it is done.
std::string done_in_words(const FrameNote& frame) {
  if (frame.begun_ms == 0) return "done";
  return fmt::format(
      "done in {}, {} of threads",
      core::format_duration(1e-3 * static_cast<double>(core::wall_ms() - frame.begun_ms)),
      core::format_duration(1e-9 * static_cast<double>(frame.render_ns)));
}

}  // namespace

void FrameProgress::merged(const Merge& merge) {
  FilmStore* film_store = nullptr;
  {
    const StateLock lock(context_.mutex);
    if (ActiveJob* active = jobs_.find(merge.job)) film_store = active->film_store.get();
  }
  if (film_store == nullptr) return;
  const int64_t begun_us = core::wall_us();
  const core::Status status = film_store->merge(merge.record);
  {
    const StateLock lock(context_.mutex);
    ActiveJob* active = jobs_.find(merge.job);
    if (active == nullptr) return;
    if (!status) {
      // Checked when it arrived: this is a bug. The finisher will find that the film is not whole.
      jobs_.note(*active, v1::LOG_LEVEL_ERROR, merge.unit.frame, {},
                 "a film cannot be merged: " + status.error().message);
      return;
    }
    const uint64_t samples = samples_of(*active, merge.unit.tile, merge.unit.batches);
    active->touch(merge.unit.frame).samples_done += samples;
    active->samples_done += samples;
    count_film(*active, merge, begun_us);
    if (std::chrono::steady_clock::now() - active->noise_measured < kNoiseEvery) return;
  }
  measure_noise(merge.job, merge.unit.frame);
}

/// Tells those who ask how noisy the frame's film is. On the film store's thread, where it is.
void FrameProgress::measure_noise(JobId job, int32_t frame) {
  std::shared_ptr<const core::Film> film;
  float exposure = 0;
  {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(job);
    if (active == nullptr) return;
    film = active->film_store->film(frame);
    exposure = active->threshold.aim.exposure;
  }
  const double noise = film ? core::picture_noise(*film, exposure) : -1;
  if (noise < 0) return;
  const StateLock lock(context_.mutex);
  if (ActiveJob* active = jobs_.find(job)) {
    active->noise = active->touch(frame).noise = noise;
    active->noise_measured = std::chrono::steady_clock::now();
  }
}

/// The film of a frame in work; null where the job has ended.
std::shared_ptr<const core::Film> FrameProgress::film_of(JobId job, int32_t frame) const {
  const StateLock lock(context_.mutex);
  const ActiveJob* active = jobs_.find(job);
  return active == nullptr ? nullptr : active->film_store->film(frame);
}

/// A film has been merged, since `begun_us`: what it took counts now.
void FrameProgress::count_film(ActiveJob& active, const Merge& merge, int64_t begun_us) {
  const auto id = static_cast<uint64_t>(active.id);
  const auto found = active.films_under_way.find(merge.record);
  if (found != active.films_under_way.end()) {
    const FilmUnderWay film = std::move(found->second);
    active.films_under_way.erase(found);
    const uint64_t samples = samples_of(active, merge.unit.tile, merge.unit.batches);
    active.stored.core_ns += film.render_ns;
    active.frames[merge.unit.frame].render_ns += film.render_ns;
    context_.meters->result("accepted");
    context_.meters->made_durable(std::chrono::steady_clock::now() - film.came);
    if (WorkerSession* session = workers_.find(film.worker)) {
      ++session->units_done;
      // What it had before the start says nothing about how fast it is.
      if (!film.is_old) session->samples_done += samples;
    }
    if (film.is_old) active.speed.skip(samples);
    const auto took_us = static_cast<int64_t>(film.render_ns / 1000);
    timelines_.note(id, {v1::TimelineStep::KIND_RENDER, film.name, film.thread, merge.unit,
                         film.came_us - took_us, film.came_us});
  }
  const int64_t now_us = core::wall_us();
  context_.meters->merged(std::chrono::microseconds(std::max<int64_t>(now_us - begun_us, 0)));
  timelines_.note(id, {v1::TimelineStep::KIND_MERGE, {}, 0, merge.unit, begun_us, now_us});
}

void FrameProgress::judge(ActiveJob& active, const JudgeTile& judge) {
  active.film_store->call([this, judge] {
    FilmStore* film_store = nullptr;
    core::NoiseThreshold threshold;
    {
      const StateLock lock(context_.mutex);
      const ActiveJob* found = jobs_.find(judge.job);
      if (found == nullptr) return;
      film_store = found->film_store.get();
      threshold = found->threshold;
    }
    if (!film_store->fetch(judge.frame)) return;
    const auto film = film_store->film(judge.frame);
    const bool enough = film && core::is_clean(*film, judge.tile, threshold);
    Turn turn(dispatcher_);
    turn.tell(TileJudged{judge.job, judge.frame, judge.tile, judge.serial, enough});
  });
}

void FrameProgress::spare(ActiveJob& active, const TileSpared& spared) {
  const core::BatchRange rest{spared.batches, core::batch_count(active.samples) - spared.batches};
  const uint64_t samples = samples_of(active, spared.tile, rest);
  active.touch(spared.frame).samples_spared += samples;
  active.samples_spared += samples;
}

void FrameProgress::tile_voided(ActiveJob& active, const TileVoided& voided) {
  uint64_t samples = 0;
  for (const core::BatchRange& batches : voided.batches) {
    samples += samples_of(active, voided.tile, batches);
  }
  FrameNote& frame = active.touch(voided.frame);
  samples = std::min(samples, frame.samples_done);
  frame.samples_done -= samples;
  active.samples_done -= samples;
  const uint32_t all = core::batch_count(active.samples);
  const uint64_t spared = samples_of(active, voided.tile, {all - voided.spared, voided.spared});
  frame.samples_spared -= spared;
  active.samples_spared -= spared;
  jobs_.note(active, v1::LOG_LEVEL_WARNING, voided.frame, {},
             fmt::format("tile {},{} is rendered again: a quarantined worker had a part in it",
                         voided.tile.x0, voided.tile.y0));
}

void FrameProgress::reopened(ActiveJob& active, const FrameReopened& action) {
  const int32_t frame = action.frame;
  active.complete.erase(frame);
  active.touch(frame).state = v1::FRAME_STATE_RENDERING;
  active.black.erase(frame);
  jobs_.note(active, v1::LOG_LEVEL_WARNING, frame, {},
             "is not done: a unit that was rendered differently twice is rendered once more");
  // Should this be lost, or come after the frame is done again, it is rendered again or stays.
  context_.in_background(active, [this, id = active.stored.id, frame] {
    (void)context_.store->forget_frames(id, {&frame, 1});
    return true;
  });
}

void FrameProgress::finish(ActiveJob& active, const FinishFrame& finish) {
  active.touch(finish.frame).state = v1::FRAME_STATE_FINISHING;
  if (active.complete.contains(finish.frame)) return hand_over(active, finish);
  // By any thread, as a result may be what completes a frame: the film store's may still be merging
  // its last film, and comes to this when it has.
  active.film_store->call([this, finish, film_store = active.film_store.get()] {
    if (!film_store->fetch(finish.frame)) return;
    measure_noise(finish.job, finish.frame);
    const std::shared_ptr<const core::Film> film = film_of(finish.job, finish.frame);
    const StateLock again(context_.mutex);
    ActiveJob* still = jobs_.find(finish.job);
    if (still == nullptr) return;
    still->complete[finish.frame] = film;
    hand_over(*still, finish);
  });
}

void FrameProgress::hand_over(ActiveJob& active, const FinishFrame& finish) {
  finisher_.add(active, finish, workers_.stable_ids_of(finish.unconfirmed));
}

void FrameProgress::done(ActiveJob& active, const FrameDone& action) {
  if (active.ending) return;
  const int32_t frame = action.frame;
  active.film_store->forget(frame, FrameEnd::finished);
  active.complete.erase(frame);
  FrameNote& noted = active.touch(frame);
  noted.state = v1::FRAME_STATE_DONE;
  active.in_work.erase(frame);
  active.stored.preview = frame;
  // Where another turn was quicker to tell that all frames are over, this one is among them.
  if (!active.making_videos) ++active.stored.frames_done;
  jobs_.note(active, v1::LOG_LEVEL_INFO, frame, {}, done_in_words(noted));
}

void FrameProgress::failed(ActiveJob& active, const FrameFailed& action) {
  if (active.ending) return;
  const int32_t frame = action.frame;
  const bool complete = active.complete.erase(frame) > 0;
  active.film_store->forget(frame, complete ? FrameEnd::unwritten : FrameEnd::failed);
  FrameNote& noted = active.touch(frame);
  noted.state = v1::FRAME_STATE_FAILED;
  active.in_work.erase(frame);
  active.failed.insert(frame);
  noted.reason = active.reasons.share(farm::wire_text(action.reason));
  active.samples_done -= std::exchange(noted.samples_done, 0);
  active.samples_spared -= std::exchange(noted.samples_spared, 0);
  ++active.stored.frames_failed;
  jobs_.note(active, v1::LOG_LEVEL_ERROR, frame, {}, "failed: " + action.reason);
}

void FrameProgress::restarted(ActiveJob& active, const FrameRestarted& action) {
  const int32_t frame = action.frame;
  FrameNote& noted = active.touch(frame);
  if (noted.state == v1::FRAME_STATE_FAILED) --active.stored.frames_failed;
  if (noted.state == v1::FRAME_STATE_DONE) --active.stored.frames_done;
  active.complete.erase(frame);
  noted.state = v1::FRAME_STATE_WAITING;
  active.in_work.erase(frame);
  active.failed.erase(frame);
  active.black.erase(frame);
  noted.reason.reset();
  noted.worker_class.clear();
  noted.noise.reset();
  ++noted.restarts;
  active.samples_done -= std::exchange(noted.samples_done, 0);
  active.samples_spared -= std::exchange(noted.samples_spared, 0);
  jobs_.note(active, v1::LOG_LEVEL_WARNING, frame, {}, "is rendered again from its beginning");
}

}  // namespace hyades::coordinator
