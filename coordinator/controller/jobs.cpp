// What clients want done with jobs.
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/not_there.h"
#include "core/base/failpoint.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kLongestName = 200;
constexpr size_t kMostMissingTold = 100;  // an error travels in headers, which are short
constexpr std::chrono::seconds kSubmitPatience{2};
/// For what is left of a job that has ended: less than that for which others wait for this one.
constexpr std::chrono::milliseconds kAwayPatience{1500};
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

grpc::Status Controller::submit(const v1::SubmitRequest& request, bool owner_proven,
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
  if (const grpc::Status room = admit(0); !room.ok()) return room;
  if (const grpc::Status here = files_are_here(request.spec()); !here.ok()) return here;
  const std::unique_lock one(submit_mutex_, kSubmitPatience);
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
  auto active = make_active_job(stored, request.spec(), *assets_, options_.film_memory);
  if (!active) return wrong(active.error().message);
  if (!has_room_for((*active)->stored)) {
    return no_room();
  }
  const auto added = store_->add_job((*active)->stored);
  if (!added) return farm::unavailable(added.error());
  core::failpoint("job-stored");
  response.set_existed(added->existed);
  if (!added->existed) {
    (*active)->id = JobId{added->id};
    (*active)->stored.id = added->id;
    {
      const std::lock_guard lock(mutex_);
      note(**active, v1::LOG_LEVEL_INFO, std::nullopt, {},
           fmt::format("submitted by {}: {} frames",
                       stored.owner.empty() ? "nobody in particular" : stored.owner,
                       (*active)->numbers.size()));
    }
    if (core::Status started = start(std::move(*active), {}); !started) {
      // Nothing was promised yet.
      (void)store_->remove_job(added->id);
      return farm::unavailable(started.error());
    }
  }
  v1::GetJobResponse now;
  const grpc::Status got = get(added->id, std::nullopt, now);
  *response.mutable_job() = now.job();
  return got;
}

/// Whether the memory that open jobs may take holds another one.
bool Controller::has_room_for(const StoredJob& job) const {
  const std::lock_guard lock(mutex_);
  uint64_t frames = job.frames;
  uint64_t bytes = job.spec.size();
  for (const auto& [id, active] : jobs_) {
    frames += active->numbers.size();
    bytes += active->stored.spec.size();
  }
  return frames <= kMostOpenFrames && bytes <= kMostOpenSpecBytes;
}

bool Controller::is_here(const v1::JobFile& file) {
  const auto digest = farm::digest_from_wire(file.sha256());
  return digest && assets_->contains(core::to_hex(*digest), file.size());
}

/// FAILED_PRECONDITION, naming those files of a job (which files_of has accepted) that are not.
grpc::Status Controller::files_are_here(const v1::JobSpec& spec) {
  v1::ErrorDetail missing;
  size_t count = 0;
  for (const v1::JobFile& file : spec.files()) {
    if (is_here(file)) continue;
    if (++count <= kMostMissingTold) missing.add_missing(file.sha256());
  }
  if (count == 0) return grpc::Status::OK;
  return farm::wire_status(grpc::StatusCode::FAILED_PRECONDITION,
                           fmt::format("{} of the job's files are not here yet", count), missing);
}

/// Waits for what is left of a job whose end is being stored; without the lock.
grpc::Status Controller::wait_until_away(uint64_t id) {
  std::unique_lock lock(mutex_);
  const bool away = away_wake_.wait_for(lock, kAwayPatience, [&] {
    const ActiveJob* active = active_job(id);
    return stop_ || ((active == nullptr || !active->ending) && !leaving_.contains(id));
  });
  if (away && !stop_) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           fmt::format("the end of job {} is still being stored", id),
                           std::chrono::seconds(1));
}

grpc::Status Controller::retry(uint64_t id, v1::Job& now) {
  const std::unique_lock one(submit_mutex_, kSubmitPatience);
  if (!one) return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
  std::vector<Action> later;
  bool open = false;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    open = active != nullptr && !active->ending;
    if (open) {
      note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {}, "failed frames are taken up again");
      later = tell(FramesRetried{active->id});
      now = describe(*active);
    }
  }
  carry_out(later);
  if (open) return grpc::Status::OK;
  if (const grpc::Status away = wait_until_away(id); !away.ok()) return away;
  auto stored = store_->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return no_job(id);
  StoredJob& job = **stored;
  if (!has_ended(job.state)) return not_open(id);
  const auto doubtful = store_->doubtful(id, 1);
  if (!doubtful) return farm::unavailable(doubtful.error());
  if (job.state == StoredState::done && doubtful->empty()) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            fmt::format("job {} is done: there is nothing to take up again", id)};
  }
  if (!has_room_for(job)) return no_room();
  const auto frames = store_->frames(id);
  if (!frames) return farm::unavailable(frames.error());
  for (const StoredFrame& frame : *frames) {
    if (frame.done) continue;
    if (auto gone = store_->forget_frame(id, frame.frame); !gone)
      return farm::unavailable(gone.error());
  }
  const StoredJob before = job;
  job.state = StoredState::running;
  job.ended_ms = 0;
  job.reason.clear();
  if (core::Status noted = store_->update_job(job); !noted) return farm::unavailable(noted.error());
  if (core::Status taken = recover(id); !taken) {
    job = before;  // done, if only some of its pictures are in doubt
    job.reason = "could not be taken up again: " + taken.error().message;
    (void)store_->update_job(job);  // where this fails too it is tried again at the next start
    return {grpc::StatusCode::FAILED_PRECONDITION, taken.error().message};
  }
  {
    const std::lock_guard lock(mutex_);
    if (ActiveJob* active = active_job(id)) {
      note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {}, "taken up again");
    }
  }
  v1::GetJobResponse got;
  const grpc::Status status = get(id, std::nullopt, got);
  now = got.job();
  return status;
}

grpc::Status Controller::remove(uint64_t id) {
  const std::unique_lock one(submit_mutex_, kSubmitPatience);
  if (!one) return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
  {
    const std::lock_guard lock(mutex_);
    const ActiveJob* active = active_job(id);
    if (active != nullptr && !active->ending) {
      return {grpc::StatusCode::FAILED_PRECONDITION,
              fmt::format("job {} has not ended: cancel it first", id)};
    }
  }
  if (const grpc::Status away = wait_until_away(id); !away.ok()) return away;
  const auto stored = store_->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return no_job(id);
  const auto remove_folders = [&] {
    std::error_code ignored;  // what stays is found after the next start
    std::filesystem::remove_all(films_folder(id), ignored);
    std::filesystem::remove_all(output_folder(id), ignored);
  };
  core::Status removed = store_->remove_job(id);
  if (!removed) {
    // A full disk cannot even store that the job is gone: what is to go makes the room.
    remove_folders();
    removed = store_->remove_job(id);
  }
  if (!removed) return farm::unavailable(removed.error());
  {
    const std::lock_guard lock(mutex_);
    timelines_.forget(id);
  }
  remove_folders();
  // Its files have been of use until now: they stay for a while, should it come again.
  v1::JobSpec spec;
  if (spec.ParseFromString((*stored)->spec)) {
    for (const v1::JobFile& file : spec.files()) {
      if (const auto digest = farm::digest_from_wire(file.sha256())) {
        assets_->touch(core::to_hex(*digest));
      }
    }
  }
  ++asset_changes_;
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
