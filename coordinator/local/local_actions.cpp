// What a run does of what the scheduler says.
#include <chrono>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "coordinator/local/local_run.h"
#include "core/film/noise.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kNoiseEvery = std::chrono::seconds(1);

}  // namespace

void LocalRun::carry_out(const std::vector<DeferredAction>& actions) {
  for (const DeferredAction& action : actions) {
    std::visit([this](const auto& one) { act(one); }, action);
  }
}

void LocalRun::act(const Persist& persist) {
  // A unit's film is handed over by the thread that has it, see deliver().
  if (std::holds_alternative<UnitRecord>(persist.record)) return;
  film_store_.append(persist.id, persist.record);
}

/// By the store's thread, whose films they are, once it has merged what was handed over before.
void LocalRun::judge_later(const JudgeTile& judge) {
  film_store_.call([this, judge] {
    const auto film = film_store_.film(judge.frame);
    const bool enough = film && core::is_clean(*film, judge.tile, plan_.threshold);
    carry_out(tell(TileJudged{kJob, judge.frame, judge.tile, judge.serial, enough}));
  });
}

void LocalRun::spare(const TileSpared& spared) {
  const core::BatchRange rest{spared.batches, batches_of(plan_).count - spared.batches};
  const uint64_t samples = core::samples_in(spared.tile, rest, plan_.samples);
  spared_ += samples;
  spared_samples_[spared.frame] += samples;
}

void LocalRun::act(const Merge& merge) {
  if (const core::Status merged = film_store_.merge(merge.record); !merged) {
    const core::MutexLock lock(mutex_);
    end_locked("a film cannot be merged: " + merged.error().message);
    return;
  }
  const core::Film& film = *film_store_.film(merge.unit.frame);
  note_film(merge.unit.frame, film);
  if (audience_ == nullptr) return;
  audience_->grown(merge.unit.frame, film, merge.unit.tile);
  carry_out(tell(FrameWatched{kJob, merge.unit.frame}));
}

void LocalRun::act(const FinishFrame& finish) {
  std::shared_ptr<const core::Film> film;
  {
    const core::MutexLock lock(mutex_);
    if (outgrown_.contains(finish.frame)) return;  // with its last unit; it fails
    works_.erase(finish.frame);
    in_flight_.insert(finish.frame);
    // The store's films are its thread's; a second attempt comes from the finishing thread.
    auto& complete = complete_[finish.frame];
    if (!complete) complete = film_store_.film(finish.frame);
    film = complete;
    to_finish_.push_back({finish.frame, film});
    finish_wake_.notify_one();
  }
  if (audience_ != nullptr) audience_->complete(finish.frame, *film);
}

void LocalRun::act(const FrameDone& done) {
  film_store_.forget(done.frame, FrameEnd::finished);
  const core::MutexLock lock(mutex_);
  spared_samples_.erase(done.frame);
  in_flight_.erase(done.frame);
  complete_.erase(done.frame);
  frame_samples_.erase(done.frame);
  ++progress_.frames_done;
  if (const auto begun = begun_.extract(done.frame)) {
    finished_.push_back({done.frame, seconds(std::chrono::steady_clock::now() - begun.mapped())});
  }
}

void LocalRun::act(const FrameFailed& failed) {
  const core::MutexLock lock(mutex_);
  film_store_.forget(failed.frame,
                     complete_.contains(failed.frame) ? FrameEnd::unwritten : FrameEnd::failed);
  works_.erase(failed.frame);
  in_flight_.erase(failed.frame);
  begun_.erase(failed.frame);
  complete_.erase(failed.frame);
  progress_.samples -= samples_per_frame();
  spared_ -= spared_samples_[failed.frame];
  progress_.samples_done -= frame_samples_[failed.frame];
  frame_samples_.erase(failed.frame);
  spared_samples_.erase(failed.frame);
  ++progress_.frames_failed;
  outcome_.failures.push_back({failed.frame, failed.reason});
}

/// A film was lost on its way to the disk: its unit will be rendered again.
void LocalRun::act(const Reject& reject) {
  const core::MutexLock lock(mutex_);
  count_locked(reject.unit, false);
}

void LocalRun::act(const JobEnded& /*ended*/) {
  const core::MutexLock lock(mutex_);
  outcome_.complete = true;
  end_locked({});
}

uint64_t LocalRun::samples_of(const core::Unit& unit) const {
  return core::samples_in(unit.tile, to_render(unit).batches, plan_.samples);
}

uint64_t LocalRun::samples_per_frame() const {
  return core::samples_in(plan_.region, batches_of(plan_), plan_.samples);
}

core::Unit LocalRun::to_render(core::Unit unit) const {
  unit.batches.first += batches_of(plan_).first;
  return unit;
}

void LocalRun::count_locked(const core::Unit& unit, bool done) {
  if (!in_flight_.contains(unit.frame)) return;
  const uint64_t samples = samples_of(unit);
  progress_.units_done += done ? 1 : 0;
  progress_.samples_done += done ? samples : -samples;
  frame_samples_[unit.frame] += done ? samples : -samples;
}

void LocalRun::note_film(int32_t frame, const core::Film& film) {
  const TimePoint now = std::chrono::steady_clock::now();
  if (now - last_noise_ < kNoiseEvery) return;
  last_noise_ = now;
  const double noise = core::picture_noise(film, plan_.threshold.aim.exposure);
  const core::MutexLock lock(mutex_);
  progress_.noise = noise;
  progress_.noise_frame = frame;
}

}  // namespace hyades::coordinator
