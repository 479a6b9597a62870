#include "coordinator/controller/job_intake.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/job_queries.h"
#include "coordinator/controller/job_recovery.h"
#include "coordinator/controller/job_steering.h"
#include "coordinator/controller/not_there.h"
#include "coordinator/controller/sweeper.h"
#include "coordinator/controller/wall_clock.h"
#include "core/base/failpoint.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kLongestName = 200;
constexpr size_t kMostMissingTold = 100;  // an error travels in headers, which are short
/// For what is left of a job that has ended: less than that for which others wait for this one.
constexpr std::chrono::milliseconds kLeavePatience{1500};
/// Of all open jobs together: what they have in memory.
constexpr uint64_t kMostOpenFrames = 2'000'000;
constexpr uint64_t kMostOpenSpecBytes = uint64_t{128} << 20U;
constexpr uint32_t kMostAttempts = 100;

bool is_one_line(const std::string& text) {
  return std::none_of(text.begin(), text.end(),
                      [](unsigned char c) { return c < ' ' || c == 127; });
}

grpc::Status overloaded(const char* why, std::chrono::milliseconds retry_after) {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, why, retry_after);
}

grpc::Status no_room() {
  return overloaded("the open jobs have as many frames or files as there may be",
                    std::chrono::seconds(60));
}

grpc::Status wrong(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

}  // namespace

grpc::Status JobIntake::submit(const v1::SubmitRequest& request, bool owner_proven,
                               v1::SubmitResponse& response) {
  const std::string& key = request.idempotency_key();
  if (!key.empty() && (key.size() < 16 || key.size() > 64)) {
    return wrong("idempotency_key has to have 16 to 64 characters");
  }
  if (request.owner().size() > kLongestName) return wrong("owner: at most 200 characters");
  if (!is_one_line(request.owner())) {
    return wrong("owner: expected one line of printable characters");
  }
  if (!is_one_line(request.spec().name())) {
    return wrong("name: expected one line of printable characters");
  }
  if (const grpc::Status sane = check_priority(request.priority()); !sane.ok()) return sane;
  auto tags = farm::check_tags({request.tags().begin(), request.tags().end()});
  if (!tags) return wrong(tags.error().message);
  if (request.max_attempts() > kMostAttempts) return wrong("max_attempts: at most 100");
  if (request.frame_order() < 0 || request.frame_order() > v1::FRAME_ORDER_PROGRESSIVE) {
    return wrong("frame_order: expected sequential or progressive");
  }
  const auto files = files_of(request.spec());
  if (!files) return wrong(files.error().message);
  if (const grpc::Status room = disk_.admit(0); !room.ok()) return room;
  if (const grpc::Status here = files_are_here(request.spec()); !here.ok()) return here;
  const std::unique_lock one(shared_.submissions, Shared::kSubmissionPatience);
  if (!one) return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
  // What was not needed may have been removed meanwhile; from here on nothing is.
  if (const grpc::Status here = files_are_here(request.spec()); !here.ok()) return here;
  StoredJob stored;
  stored.key = key;
  stored.spec = request.spec().SerializeAsString();
  stored.owner = request.owner();
  stored.owner_proven = owner_proven;
  stored.priority = request.priority();
  stored.max_workers = request.max_workers();
  stored.tags = std::move(*tags);
  stored.memory = request.memory_bytes();
  if (request.max_attempts() > 0) stored.max_attempts = request.max_attempts();
  if (request.frame_order() != 0) stored.frame_order = request.frame_order();
  stored.submitted_ms = wall_ms();
  auto active =
      make_active_job(stored, request.spec(), *shared_.assets, shared_.options.film_memory);
  if (!active) return wrong(active.error().message);
  if (!has_room_for((*active)->stored)) {
    return no_room();
  }
  const auto added = shared_.store->add_job((*active)->stored);
  if (!added) return farm::unavailable(added.error());
  core::failpoint("job-stored");
  response.set_existed(added->existed);
  if (!added->existed) {
    (*active)->id = JobId{added->id};
    (*active)->stored.id = added->id;
    {
      const StateLock lock(shared_.mutex);
      jobs_.note(**active, v1::LOG_LEVEL_INFO, std::nullopt, {},
                 fmt::format("submitted by {}: {} frames",
                             stored.owner.empty() ? "nobody in particular" : stored.owner,
                             (*active)->numbers.size()));
    }
    if (core::Status started = recovery_.start(std::move(*active), {}); !started) {
      // Nothing was promised yet.
      (void)shared_.store->remove_job(added->id);
      return farm::unavailable(started.error());
    }
  }
  v1::GetJobResponse now;
  const grpc::Status got = queries_.get(added->id, std::nullopt, now);
  *response.mutable_job() = now.job();
  return got;
}

/// Whether the memory that open jobs may take holds another one.
bool JobIntake::has_room_for(const StoredJob& job) const {
  const StateLock lock(shared_.mutex);
  uint64_t frames = job.frames;
  uint64_t bytes = job.spec.size();
  for (const auto& [id, active] : jobs_.all()) {
    frames += active->numbers.size();
    bytes += active->stored.spec.size();
  }
  return frames <= kMostOpenFrames && bytes <= kMostOpenSpecBytes;
}

/// FAILED_PRECONDITION, naming those files of a job (which files_of has accepted) that are not.
grpc::Status JobIntake::files_are_here(const v1::JobSpec& spec) {
  v1::ErrorDetail missing;
  size_t count = 0;
  for (const v1::JobFile& file : spec.files()) {
    if (is_stored(file, *shared_.assets)) continue;
    if (++count <= kMostMissingTold) missing.add_missing(file.sha256());
  }
  if (count == 0) return grpc::Status::OK;
  return farm::wire_status(grpc::StatusCode::FAILED_PRECONDITION,
                           fmt::format("{} of the job's files are not here yet", count), missing);
}

/// Waits for what is left of a job whose end is being stored.
grpc::Status JobIntake::wait_until_left(uint64_t id) {
  const TimePoint patience = std::chrono::steady_clock::now() + kLeavePatience;
  if (jobs_.wait_until_left(id, patience, shared_.stop)) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           fmt::format("the end of job {} is still being stored", id),
                           std::chrono::seconds(1));
}

grpc::Status JobIntake::retry(uint64_t id, v1::Job& now) {
  const std::unique_lock one(shared_.submissions, Shared::kSubmissionPatience);
  if (!one) return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
  {
    Turn turn(dispatcher_);
    ActiveJob* active = jobs_.find(id);
    if (active != nullptr && !active->ending) {
      jobs_.note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {}, "failed frames are taken up again");
      turn.tell(FramesRetried{active->id});
      now = queries_.describe(*active);
      return grpc::Status::OK;
    }
  }
  if (const grpc::Status left = wait_until_left(id); !left.ok()) return left;
  auto stored = shared_.store->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return no_job(id);
  StoredJob& job = **stored;
  if (!has_ended(job.state)) return why_not_open(*shared_.store, id);
  const auto doubtful = shared_.store->doubtful(id, 1);
  if (!doubtful) return farm::unavailable(doubtful.error());
  if (job.state == StoredState::done && doubtful->empty()) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            fmt::format("job {} is done: there is nothing to take up again", id)};
  }
  if (!has_room_for(job)) return no_room();
  const auto frames = shared_.store->frames(id);
  if (!frames) return farm::unavailable(frames.error());
  for (const StoredFrame& frame : *frames) {
    if (frame.done) continue;
    if (auto gone = shared_.store->forget_frame(id, frame.frame); !gone)
      return farm::unavailable(gone.error());
  }
  const StoredJob before = job;
  job.state = StoredState::running;
  job.ended_ms = 0;
  job.reason.clear();
  if (core::Status noted = shared_.store->update_job(job); !noted)
    return farm::unavailable(noted.error());
  if (core::Status taken = recovery_.recover(id); !taken) {
    job = before;  // done, if only some of its pictures are in doubt
    job.reason = "could not be taken up again: " + taken.error().message;
    (void)shared_.store->update_job(
        job);  // where this fails too it is tried again at the next start
    return {grpc::StatusCode::FAILED_PRECONDITION, taken.error().message};
  }
  {
    const StateLock lock(shared_.mutex);
    if (ActiveJob* active = jobs_.find(id)) {
      jobs_.note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {}, "taken up again");
    }
  }
  v1::GetJobResponse got;
  const grpc::Status status = queries_.get(id, std::nullopt, got);
  now = got.job();
  return status;
}

grpc::Status JobIntake::remove(uint64_t id) {
  const std::unique_lock one(shared_.submissions, Shared::kSubmissionPatience);
  if (!one) return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
  {
    const StateLock lock(shared_.mutex);
    const ActiveJob* active = jobs_.find(id);
    if (active != nullptr && !active->ending) {
      return {grpc::StatusCode::FAILED_PRECONDITION,
              fmt::format("job {} has not ended: cancel it first", id)};
    }
  }
  if (const grpc::Status left = wait_until_left(id); !left.ok()) return left;
  const auto stored = shared_.store->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return no_job(id);
  const auto remove_folders = [&] {
    std::error_code ignored;  // what stays is found after the next start
    std::filesystem::remove_all(shared_.films_folder(id), ignored);
    std::filesystem::remove_all(shared_.output_folder(id), ignored);
  };
  core::Status removed = shared_.store->remove_job(id);
  if (!removed) {
    // A full disk cannot even store that the job is gone: what is to go makes the room.
    remove_folders();
    removed = shared_.store->remove_job(id);
  }
  if (!removed) return farm::unavailable(removed.error());
  timelines_.forget(id);
  remove_folders();
  // Its files have been of use until now: they stay for a while, should it come again.
  v1::JobSpec spec;
  if (spec.ParseFromString((*stored)->spec)) {
    for (const v1::JobFile& file : spec.files()) {
      if (const auto digest = farm::digest_from_wire(file.sha256())) {
        shared_.assets->touch(core::to_hex(*digest));
      }
    }
  }
  sweeper_.job_removed();
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
