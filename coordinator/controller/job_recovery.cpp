#include "coordinator/controller/job_recovery.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "coordinator/controller/job_starter.h"
#include "core/base/wall_clock.h"
#include "core/job/output_path.h"
#include "core/job/video.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// For the documents of others to be read: a few of the longest. Who reopens a job asks once.
constexpr std::chrono::seconds kRecoveryPatience{30};

/// What a job's log says where it goes on by itself.
constexpr const char* kRestarted = "goes on: the coordinator has been started again";

std::string reason_to_wait(const core::Error& why) {
  return "waits to be recovered: " + why.message;
}

}  // namespace

bool is_stored(const v1::JobFile& file, farm::ContentStore& assets) {
  const auto digest = farm::digest_from_wire(file.sha256());
  return digest && assets.contains(core::to_hex(*digest), file.size());
}

/// Whether a file of the job is gone, also one that was found damaged; nothing where that cannot be
/// told now.
std::optional<bool> JobRecovery::lacks_files(const v1::JobSpec& spec) {
  farm::ContentStore& assets = *context_.assets;
  for (const v1::JobFile& file : spec.files()) {
    const auto digest = farm::digest_from_wire(file.sha256());
    if (!digest) return true;
    const std::string name = core::to_hex(*digest);
    if (assets.missing(name)) return true;
    // One that is damaged is gone once it was read.
    if (assets.read(name)) continue;
    if (assets.missing(name)) return true;
    return std::nullopt;
  }
  return false;
}

JobRead JobRecovery::read(uint64_t id) {
  const auto stored = context_.store->job(id);
  if (!stored) return {stored.error(), Obstacle::passing};
  if (!*stored) return {core::Error{"it is not there"}, Obstacle::lasting};
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) {
    return {core::Error{"its record is damaged"}, Obstacle::lasting};
  }
  for (const v1::JobFile& file : spec.files()) {
    if (is_stored(file, *context_.assets)) continue;
    const core::Error gone{
        file.path() +
        " is gone or damaged on the coordinator's disk: submit the job (or the file with another) "
        "again, then 'retry' renders this one"};
    return {gone, lacks_files(spec).value_or(false) ? Obstacle::lasting : Obstacle::passing};
  }
  const auto document = context_.documents.read(spec, kRecoveryPatience, (*stored)->owner);
  if (!document) {
    return {core::Error{"the documents of other jobs are being read"}, Obstacle::others_are_read};
  }
  auto active = *document ? make_active_job(**stored, spec, ***document, *context_.assets,
                                            context_.options.film_memory)
                          : core::Result<std::unique_ptr<ActiveJob>>(document->error());
  if (active) return {std::move(active), Obstacle::none};
  return {std::move(active), lacks_files(spec) ? Obstacle::lasting : Obstacle::passing};
}

core::Status JobRecovery::recover_all() {
  const auto ids = context_.store->open_jobs();
  if (!ids) return ids.error();
  {
    const core::MutexLock lock(mutex_);
    not_tried_ = ids->size();
  }
  for (const uint64_t id : *ids) recover_in_background(id);
  const auto end = std::chrono::steady_clock::now() + context_.options.recovery_time;
  core::MutexLock lock(mutex_);
  while (not_tried_ > 0 && std::chrono::steady_clock::now() < end) tried_.wait_until(mutex_, end);
  return {};
}

void JobRecovery::recover_in_background(uint64_t id) {
  StoredJob waiting;
  if (auto stored = context_.store->summary(id); stored && *stored) waiting = std::move(**stored);
  waiting.id = id;
  waiting.reason = "waits to be recovered: the coordinator has just been started";
  const std::string owner = waiting.owner;
  const StateLock lock(context_.mutex);
  jobs_.wait_for_recovery(std::move(waiting));
  queue_.add(
      id,
      [this, id, first = true]() mutable {
        const bool over = recover_later(id);
        if (std::exchange(first, false)) {
          const core::MutexLock one(mutex_);
          --not_tried_;
          tried_.notify_all();
        }
        return over;
      },
      owner);
}

/// Whether there is nothing left to try; for the job's tasks.
bool JobRecovery::recover_later(uint64_t id) {
  const core::Result<bool> over = try_to_recover(id);
  const StateLock lock(context_.mutex);
  if (!over) jobs_.still_waits(id, reason_to_wait(over.error()));
  if (!over || !*over) return false;
  jobs_.no_longer_waits(id);
  return true;
}

/// Whether there is nothing left to try; an error says what stands in the way.
core::Result<bool> JobRecovery::try_to_recover(uint64_t id) {
  if (context_.stop) return true;
  JobRead again = read(id);  // others submit meanwhile
  const Obstacle obstacle = again.obstacle;
  std::unique_ptr<JobTable::Recovery> mine;
  {
    // Not while somebody deletes it, or unused files are swept.
    const auto one = context_.wait_for_submissions();
    if (!one) return false;
    const auto state = context_.store->state(id);
    if (!state) return state.error();
    if (!*state || has_ended(**state)) return true;  // somebody has deleted it
    const StateLock lock(context_.mutex);
    if (jobs_.find(JobId{id}) != nullptr) return true;  // cancelled, and retried
    mine = jobs_.begin_recovery(id, {});
    if (!mine) return false;
  }
  const core::Status recovered = recover(id, std::move(again), kRestarted);
  if (recovered || (obstacle == Obstacle::lasting && give_up(id, recovered.error()))) return true;
  if (obstacle == Obstacle::others_are_read) return false;
  // Perhaps the disk is full, or does not answer: the job waits, and says why. Nobody ends it
  // meanwhile.
  const std::string why = reason_to_wait(recovered.error());
  auto stored = context_.store->summary(id);
  if (stored && *stored && (*stored)->reason != why) {
    (*stored)->reason = why;
    (void)context_.store->update_job(**stored);
  }
  return recovered.error();
}

/// The job fails alone, with the reason kept; `retry` reopens it.
core::Status JobRecovery::give_up(uint64_t id, const core::Error& why) {
  auto stored = context_.store->job(id);
  if (!stored) return stored.error();
  if (!*stored) return {};
  (*stored)->state = StoredState::failed;
  (*stored)->ended_ms = core::wall_ms();
  (*stored)->reason = "could not be recovered: " + why.message;
  return context_.store->update_job(**stored);
}

core::Status JobRecovery::recover(uint64_t id, JobRead read, const std::string& told) {
  if (!read.job) return read.job.error();
  auto stored = context_.store->job(id);
  if (!stored) return stored.error();
  if (!*stored) return core::Error{"it is not there"};
  std::optional<RestoredJob> restored;
  if (core::Status done = restore(**read.job, std::move(**stored), told, restored); !done) {
    return done;
  }
  return starter_.start(std::move(*read.job), std::move(*restored));
}

/// Takes in how the job is stored by now, and what its frames and outputs are.
core::Status JobRecovery::restore(ActiveJob& active, StoredJob now, const std::string& told,
                                  std::optional<RestoredJob>& restored) {
  const NotSharedYet alone;
  // What its document says was read; all else may have changed meanwhile.
  now.name = std::move(active.stored.name);
  now.options = std::move(active.stored.options);
  now.frames = active.stored.frames;
  now.samples = active.stored.samples;
  now.reason.clear();  // why it waited
  active.stored = std::move(now);
  active.id = JobId{active.stored.id};
  active.account_is_stored(active.stored);
  jobs_.note(active, v1::LOG_LEVEL_INFO, std::nullopt, {}, told);
  auto found = restore_frames(active);
  if (!found) return found.error();
  restored = std::move(*found);
  return {};
}

/// The frames of the job that are over. Why they failed is noted as it is read, a page at a time.
core::Result<std::vector<StoredFrame>> JobRecovery::frames_over(ActiveJob& active) const {
  std::vector<StoredFrame> all;
  std::optional<int32_t> after;
  for (;;) {
    auto page = context_.store->frames(static_cast<uint64_t>(active.id), after, kRowsAtOnce);
    if (!page) return page.error();
    if (page->empty()) return all;
    after = page->back().frame;
    for (StoredFrame& frame : *page) {
      std::string reason = std::exchange(frame.reason, {});
      if (!frame.done) active.frames[frame.frame].reason = active.reasons.share(std::move(reason));
      all.push_back(std::move(frame));
    }
  }
}

/// The frames of the job that are over, but for those that are rendered again.
core::Result<RestoredJob> JobRecovery::restore_frames(ActiveJob& active) {
  const auto id = static_cast<uint64_t>(active.id);
  const auto frames = frames_over(active);
  if (!frames) return frames.error();
  const auto repeated = frames_to_repeat(active, *frames);
  if (!repeated) return repeated.error();
  const std::vector<int32_t> anew(repeated->begin(), repeated->end());
  if (auto gone = context_.store->forget_frames(id, anew); !gone) return gone.error();
  RestoredJob restored;
  active.stored.preview.reset();  // it may be rendered again
  for (const StoredFrame& frame : *frames) {
    FrameNote& note = active.frames[frame.frame];
    if (repeated->contains(frame.frame)) {
      note.reason.reset();
      note.restarts = frame.restarts + 1;
      jobs_.note(
          active, v1::LOG_LEVEL_WARNING, frame.frame, {},
          frame.suspect
              ? "a worker that had a part in it was found divergent: it is rendered again"
              : "its outputs are gone or damaged, or went into a video that is made anew: it is "
                "rendered again");
      continue;
    }
    note.worker_class = frame.worker_class;
    note.restarts = frame.restarts;
    if (frame.done) {
      restored.finished.push_back(frame.frame);
      active.stored.preview = frame.frame;
      note.state = v1::FRAME_STATE_DONE;
      if (frame.black) active.black.insert(frame.frame);
      note.samples_done = active.samples_per_frame;
      active.samples_done += note.samples_done;
    } else {
      restored.failed.push_back(frame.frame);
      note.state = v1::FRAME_STATE_FAILED;
      active.failed.insert(frame.frame);
    }
  }
  active.stored.frames_done = static_cast<uint32_t>(restored.finished.size());
  active.stored.frames_failed = static_cast<uint32_t>(restored.failed.size());
  return restored;
}

/// Outputs that are missing or have another size than when they were written.
core::Result<std::vector<StoredOutput>> JobRecovery::lost_outputs(uint64_t id) const {
  std::vector<StoredOutput> lost;
  for (uint64_t after = 0;;) {
    // Of a long job there are very many, and others need the store too.
    const auto outputs = context_.store->outputs(id, after, kRowsAtOnce);
    if (!outputs) return outputs.error();
    for (const StoredOutput& output : *outputs) {
      after = output.number;
      std::error_code failed;
      const std::string path = context_.output_folder(id) + "/" + output.path;
      const auto size = std::filesystem::file_size(path, failed);
      // What cannot be looked at now may be as it should.
      if (failed && failed != std::errc::no_such_file_or_directory &&
          failed != std::errc::not_a_directory) {
        return core::Error{path + ": " + failed.message()};
      }
      if (failed || size != output.size) lost.push_back(output);
    }
    if (outputs->size() < kRowsAtOnce) return lost;
  }
}

/// Where a video is missing, or one of the frames is `repeated`, it is made anew, of all frames:
/// those of the `done` ones whose pictures went when it was made are repeated too.
core::Status JobRecovery::repeat_for_videos(const ActiveJob& active,
                                            const std::vector<int32_t>& done,
                                            std::set<int32_t>& repeated) {
  if (active.videos.empty()) return {};
  const auto id = static_cast<uint64_t>(active.id);
  const auto outputs = context_.store->outputs(id, 0, UINT32_MAX);
  if (!outputs) return outputs.error();
  std::set<std::string> paths;
  for (const StoredOutput& output : *outputs) paths.insert(output.path);
  // What one video repeats costs the others too.
  for (size_t before = repeated.size() + 1; before != repeated.size();) {
    before = repeated.size();
    for (const core::VideoDesc& video : active.videos) {
      if (repeated.empty() && paths.contains(video.file)) continue;
      if (core::Status gone = context_.store->change_outputs(id, {video.file}, {}); !gone)
        return gone;
      paths.erase(video.file);
      for (const int32_t number : done) {
        if (!paths.contains(core::output_path(video.pictures, number))) repeated.insert(number);
      }
    }
  }
  return {};
}

/// Of the frames that are over, those that are rendered again: they are suspect, or of what they
/// have written something is gone.
core::Result<std::set<int32_t>> JobRecovery::frames_to_repeat(
    const ActiveJob& active, const std::vector<StoredFrame>& frames) {
  const auto id = static_cast<uint64_t>(active.id);
  const auto lost = lost_outputs(id);
  if (!lost) return lost.error();
  std::set<int32_t> repeated;
  for (const StoredOutput& output : *lost) {
    const bool video = std::any_of(active.videos.begin(), active.videos.end(),
                                   [&](const core::VideoDesc& v) { return v.file == output.path; });
    if (!video) {
      repeated.insert(output.frame);
    } else if (core::Status gone = context_.store->change_outputs(id, {output.path}, {}); !gone) {
      return gone.error();
    }
  }
  std::vector<int32_t> done;
  for (const StoredFrame& frame : frames) {
    if (frame.done) done.push_back(frame.frame);
    if (frame.suspect) repeated.insert(frame.frame);
  }
  if (core::Status told = repeat_for_videos(active, done, repeated); !told) return told.error();
  return repeated;
}

}  // namespace hyades::coordinator
