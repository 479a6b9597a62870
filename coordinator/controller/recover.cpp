// Jobs that are there already.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/film_store_owner.h"
#include "coordinator/meters/meters.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kWaitingBytes = uint64_t{256} << 20U;
constexpr std::chrono::seconds kPatience{2};

/// Films of a progressive job that may be in memory together, and frames that may be.
constexpr uint64_t kProgressiveBytes = uint64_t{2} << 30U;
constexpr uint64_t kMostAtOnce = 256;

/// How many frames of a job may be in work together: no more than half of `film_memory` holds, or
/// one.
uint32_t frames_at_once(const ActiveJob& active, uint64_t film_memory) {
  const uint64_t film = std::max<uint64_t>(active.film_bytes, 1);
  const uint64_t wanted = active.stored.frame_order == v1::FRAME_ORDER_PROGRESSIVE
                              ? std::clamp<uint64_t>(kProgressiveBytes / film, 3, kMostAtOnce)
                              : JobPlan{}.frames_in_flight;
  return static_cast<uint32_t>(std::clamp<uint64_t>(film_memory / 2 / film, 1, wanted));
}

int32_t tile_size_for(const ActiveJob& active) {
  return tile_size_of(active.region, active.read.job.sampling.samples, active.layout.layers.splats);
}

/// Whether a job can never be taken up as it is: its record is damaged, its files are gone, or what
/// they say is not allowed here. All else (a full disk, one that does not answer) may pass.
bool lasting_obstacle(JobStore& store, farm::ContentStore& assets, uint64_t id,
                      uint64_t film_memory) {
  const auto stored = store.job(id);
  if (!stored) return false;
  if (!*stored) return true;
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) return true;
  for (const v1::JobFile& file : spec.files()) {
    const auto digest = farm::digest_from_wire(file.sha256());
    if (!digest) return true;
    const std::string name = core::to_hex(*digest);
    if (assets.missing(name)) return true;
    // One that is damaged is gone once it was read.
    if (!assets.read(name)) return assets.missing(name);
  }
  return !make_active_job(**stored, spec, assets, film_memory);
}

}  // namespace

core::Status Controller::recover_jobs() {
  const auto ids = store_->open_jobs();
  if (!ids) return ids.error();
  for (const uint64_t id : *ids) {
    core::Status taken = recover(id);
    if (taken) continue;
    if (!lasting_obstacle(*store_, *assets_, id, options_.film_memory)) {
      // Perhaps the disk is full, or did not answer: the job waits, and says why.
      StoredJob waiting;
      if (auto stored = store_->job(id); stored && *stored) waiting = std::move(**stored);
      waiting.id = id;
      waiting.reason = "waits to be taken up again: " + taken.error().message;
      if (!waiting.spec.empty()) (void)store_->update_job(waiting);
      const std::lock_guard lock(mutex_);
      waiting_jobs_[id] = std::move(waiting);
      background_.add(id, [this, id] { return recover_later(id); });
      continue;
    }
    if (core::Status noted = give_up(id, taken.error()); !noted) {
      background_.add(id, [this, id] { return recover_later(id); });
    }
  }
  return {};
}

/// Whether there is nothing left to try; for the job's tasks.
bool Controller::recover_later(uint64_t id) {
  if (!try_to_recover(id)) return false;
  const std::lock_guard lock(mutex_);
  waiting_jobs_.erase(id);
  return true;
}

bool Controller::try_to_recover(uint64_t id) {
  if (stop_) return true;
  // Not while somebody deletes it, or unused files are swept.
  const std::unique_lock one(submit_mutex_, kPatience);
  if (!one) return false;
  const auto stored = store_->job(id);
  if (!stored) return false;
  if (!*stored || has_ended((*stored)->state)) return true;  // somebody has deleted it
  const core::Status taken = recover(id);
  if (taken) return true;
  return lasting_obstacle(*store_, *assets_, id, options_.film_memory) &&
         give_up(id, taken.error()).ok();
}

/// The job fails alone, with the reason kept; `retry` takes it up again.
core::Status Controller::give_up(uint64_t id, const core::Error& why) {
  auto stored = store_->job(id);
  if (!stored) return stored.error();
  if (!*stored) return {};
  (*stored)->state = StoredState::failed;
  (*stored)->ended_ms = wall_ms();
  (*stored)->reason = "could not be taken up again: " + why.message;
  return store_->update_job(**stored);
}

core::Status Controller::recover(uint64_t id) {
  auto stored = store_->job(id);
  if (!stored) return stored.error();
  if (!*stored) return core::Error{"it is not there"};
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) return core::Error{"its record is damaged"};
  for (const v1::JobFile& file : spec.files()) {
    if (is_here(file)) continue;
    return core::Error{file.path() +
                       " is gone or damaged on the coordinator's disk: submit the job (or the "
                       "file with another) again, then 'retry' takes this one up"};
  }
  auto active = make_active_job(**stored, spec, *assets_, options_.film_memory);
  if (!active) return active.error();
  (*active)->id = JobId{id};
  RestoredJob restored;
  const auto frames = store_->frames(id);
  if (!frames) return frames.error();
  const auto repeated = frames_to_repeat(**active, *frames);
  if (!repeated) return repeated.error();
  (*active)->stored.preview.reset();  // it may be rendered again
  for (const StoredFrame& frame : *frames) {
    FrameNote& note = (*active)->frames[frame.frame];
    if (repeated->contains(frame.frame)) {
      if (auto gone = store_->forget_frame(id, frame.frame); !gone) return gone;
      note.restarts = frame.restarts + 1;
      this->note(
          **active, v1::LOG_LEVEL_WARNING, frame.frame, {},
          frame.doubtful
              ? "a worker that had a part in it was found odd: it is rendered again"
              : "its outputs are gone or damaged, or went into a video that is made anew: it is "
                "rendered again");
      continue;
    }
    note.worker_class = frame.worker_class;
    note.restarts = frame.restarts;
    if (frame.done) {
      restored.finished.push_back(frame.frame);
      (*active)->stored.preview = frame.frame;
      note.state = v1::FRAME_STATE_DONE;
      note.samples_done = (*active)->samples_per_frame;
      (*active)->samples_done += note.samples_done;
    } else {
      restored.failed.push_back({frame.frame, frame.reason});
      note.state = v1::FRAME_STATE_FAILED;
      note.reason = frame.reason;
    }
  }
  (*active)->core_ns_stored = (*active)->stored.core_ns;
  (*active)->stored.frames_done = static_cast<uint32_t>(restored.finished.size());
  (*active)->stored.frames_failed = static_cast<uint32_t>(restored.failed.size());
  return start(std::move(*active), std::move(restored));
}

/// Outputs that are missing or have another size than when they were written.
core::Result<std::vector<StoredOutput>> Controller::lost_outputs(uint64_t id) const {
  const auto outputs = store_->outputs(id, 0, UINT32_MAX);
  if (!outputs) return outputs.error();
  std::vector<StoredOutput> lost;
  for (const StoredOutput& output : *outputs) {
    std::error_code failed;
    const std::string path = output_folder(id) + "/" + output.path;
    const auto size = std::filesystem::file_size(path, failed);
    // What cannot be looked at now may be as it should.
    if (failed && failed != std::errc::no_such_file_or_directory &&
        failed != std::errc::not_a_directory) {
      return core::Error{path + ": " + failed.message()};
    }
    if (failed || size != output.size) lost.push_back(output);
  }
  return lost;
}

/// Of the frames that are over, those that are rendered again: they are in doubt, or of what they
/// have written something is gone.
core::Result<std::set<int32_t>> Controller::frames_to_repeat(
    const ActiveJob& active, const std::vector<StoredFrame>& frames) {
  const uint64_t id = active.stored.id;
  const auto lost = lost_outputs(id);
  if (!lost) return lost.error();
  std::set<int32_t> repeated;
  for (const StoredOutput& output : *lost) {
    const bool video = std::any_of(active.videos().begin(), active.videos().end(),
                                   [&](const core::VideoDesc& v) { return v.file == output.path; });
    if (!video) {
      repeated.insert(output.frame);
    } else if (core::Status gone = store_->change_outputs(id, {output.path}, {}); !gone) {
      return gone.error();
    }
  }
  std::vector<int32_t> done;
  for (const StoredFrame& frame : frames) {
    if (frame.done) done.push_back(frame.frame);
    if (frame.doubtful) repeated.insert(frame.frame);
  }
  if (core::Status told = repeat_for_videos(active, done, repeated); !told) return told.error();
  return repeated;
}

/// What of the films in a job's log counts.
void Controller::restore_films(ActiveJob& active, const LogContents& contents,
                               RestoredJob& restored) {
  for (const std::string& problem : contents.problems) {
    note(active, v1::LOG_LEVEL_WARNING, std::nullopt, {}, "films: " + problem);
  }
  restored.disputed = contents.disputed;
  if (contents.disputed) {
    note(
        active, v1::LOG_LEVEL_WARNING, std::nullopt, {},
        "workers had rendered a unit differently when the coordinator stopped: frames that are not "
        "done are rendered again from their beginning");
  }
  for (const auto& [number, units] : contents.units) {
    FrameNote& frame = active.frames[number];
    // The row may be of outputs that were made while a film was in doubt: the log has the last
    // word.
    if (frame.state == v1::FRAME_STATE_DONE && contents.disputed) {
      frame.state = v1::FRAME_STATE_WAITING;
      active.samples_done -= std::exchange(frame.samples_done, 0);
      --active.stored.frames_done;
      std::erase(restored.finished, number);
    }
    if (frame.state != v1::FRAME_STATE_WAITING) {
      active.film_store->forget(number, frame.state == v1::FRAME_STATE_DONE);
      continue;
    }
    frame.state = v1::FRAME_STATE_RENDERING;
    active.in_work.insert(number);
    frame.worker_class = units.front().worker_class;
    for (const AcceptedUnit& unit : units) {
      frame.samples_done +=
          core::samples_in(unit.unit.tile, unit.unit.batches, active.read.job.sampling.samples);
      restored.accepted.push_back(unit);
    }
    active.samples_done += frame.samples_done;
    // Will be finished at once, by another thread than the film store's, which runs by then.
    if (frame.samples_done == active.samples_per_frame) {
      active.complete[number] = active.film_store->film(number);
    }
  }
  for (const auto& [frame, finished] : contents.finished) {
    if (active.frames[frame].state != v1::FRAME_STATE_DONE) active.film_store->reopen(frame);
  }
}

/// A store of the job's films, not opened yet.
std::unique_ptr<FilmStore> Controller::make_film_store(ActiveJob& active, bool resume) {
  const uint32_t samples = active.read.job.sampling.samples;
  FilmSet films{active.numbers, active.region, samples, core::batch_count(samples)};
  FilmStoreOptions place;
  place.max_waiting_bytes = kWaitingBytes;
  place.folder = films_folder(active.stored.id);
  place.frame_key = [key = active.key](int32_t) { return key; };
  place.resume = resume;
  place.compact_bytes = options_.compact_bytes;
  place.on_sync = [meters = meters_.get()](std::chrono::nanoseconds took) { meters->synced(took); };
  if (!active.owner) active.owner = std::make_unique<FilmStoreOwner>(*this, active.id);
  return std::make_unique<FilmStore>(std::move(films), std::move(place), *active.owner);
}

/// A job gets its log and threads with its first film, so that those that wait cost little. The
/// store takes what it is given from now on; its log is opened by the job's tasks. With the lock.
FilmStore& Controller::film_store_of(ActiveJob& active) {
  if (!active.film_store) {
    active.film_store = make_film_store(active, false);
    background_.add(active.stored.id, [this, job = active.id] { return open_film_store(job); });
  }
  return *active.film_store;
}

/// Without the lock; the job stays in memory while its tasks do.
bool Controller::open_film_store(JobId job) {
  FilmStore* film_store = nullptr;
  int32_t tile_size = 0;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(job);
    if (active == nullptr || active->ending) return true;  // or its end would wait for this
    film_store = active->film_store.get();
    tile_size = tile_size_for(*active);
  }
  core::Status opened;
  if (const auto contents = film_store->open(); !contents) opened = contents.error();
  if (opened) opened = film_store->start(tile_size);
  if (!opened) storage_failed(job, opened.error().message);
  return opened.ok();
}

/// Reads the films that are there, and hands the job to the scheduler.
core::Status Controller::start(std::unique_ptr<ActiveJob> owned, RestoredJob restored) {
  ActiveJob& active = *owned;
  int32_t tile_size = tile_size_for(active);
  std::error_code unknown;
  const bool films = std::filesystem::exists(films_folder(active.stored.id), unknown);
  if (unknown) return core::Error{films_folder(active.stored.id) + ": " + unknown.message()};
  if (films) {
    active.film_store = make_film_store(active, true);
    auto contents = active.film_store->open();
    if (!contents) return contents.error();
    if (contents->cut.tile_size > 0) tile_size = contents->cut.tile_size;
    restore_films(active, *contents, restored);
    if (auto started = active.film_store->start(tile_size); !started) return started;
  }
  JobAdded added;
  added.job = active.id;
  added.plan.frames = active.numbers;
  added.plan.region = active.region;
  added.plan.tile_size = tile_size;
  added.plan.batches = core::batch_count(active.read.job.sampling.samples);
  added.plan.priority = active.stored.priority;
  added.plan.owner = active.stored.owner;
  added.plan.max_workers = active.stored.max_workers;
  added.plan.max_attempts = active.stored.max_attempts;
  added.plan.needs = {active.stored.tags, active.stored.memory};
  if (active.stored.frame_order == v1::FRAME_ORDER_PROGRESSIVE) {
    added.plan.order = FrameOrder::progressive;
  }
  added.plan.whole_frames = active.layout.layers.splats;
  added.plan.film_bytes = active.film_bytes;
  added.plan.frames_in_flight = frames_at_once(active, options_.film_memory);
  added.restored = std::move(restored);
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    const JobId id = active.id;
    const bool paused = active.stored.state == StoredState::paused;
    jobs_.emplace(id, std::move(owned));
    later = tell(added);
    if (paused) {
      for (Action& action : tell(JobPaused{id})) later.push_back(std::move(action));
    }
  }
  carry_out(later);
  return {};
}

}  // namespace hyades::coordinator
