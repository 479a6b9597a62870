#include "coordinator/controller/job_intake.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/job_queries.h"
#include "coordinator/controller/job_recovery.h"
#include "coordinator/controller/job_starter.h"
#include "coordinator/controller/job_steering.h"
#include "coordinator/controller/not_found.h"
#include "coordinator/controller/sweeper.h"
#include "coordinator/controller/video_maker.h"
#include "coordinator/film_store/remove_folder.h"
#include "core/base/failpoint.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "core/job/darkness.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostMissingListed = 100;  // an error travels in headers, which are short
/// For what is left of a job that has ended: less than ControllerContext::wait_for_submissions().
constexpr std::chrono::milliseconds kLeavePatience{1500};
constexpr uint32_t kMostAttempts = 100;
constexpr uint32_t kUsualAttempts = 3;

grpc::Status overloaded(const char* why, std::chrono::milliseconds retry_after) {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, why, retry_after);
}

grpc::Status others_submit() {
  return overloaded("other jobs are being submitted", std::chrono::milliseconds(500));
}

grpc::Status no_room() {
  return overloaded("the open jobs have as many frames or files as there may be",
                    std::chrono::seconds(60));
}

void add(const JobRoom& one, JobRoom& all) {
  all.frames += one.frames;
  all.bytes += one.bytes;
}

grpc::Status wrong(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

grpc::Status check_words(const v1::SubmitRequest& request) {
  if (request.owner().size() > kLongestName) return wrong("owner: at most 200 characters");
  if (!core::is_printable(request.owner())) {
    return wrong("owner: expected one line of printable characters");
  }
  if (!core::is_printable(request.spec().name())) {
    return wrong("name: expected one line of printable characters");
  }
  return check_priority(request.priority());
}

/// What is asked for besides what is rendered and by whom, as its job shows it: a line for each
/// such field.
core::Result<v1::Job> read_options(const v1::SubmitRequest& request) {
  const auto tags = farm::check_tags({request.tags().begin(), request.tags().end()});
  if (!tags) return tags.error();
  if (request.max_attempts() > kMostAttempts) return core::Error{"max_attempts: at most 100"};
  if (request.redundancy() > 100) return core::Error{"redundancy: expected 0 to 100 (percent)"};
  if (request.frame_order() < 0 || request.frame_order() > v1::FRAME_ORDER_PROGRESSIVE) {
    return core::Error{"frame_order: expected sequential or progressive"};
  }
  v1::Job options;
  options.set_max_workers(request.max_workers());
  options.mutable_tags()->Assign(tags->begin(), tags->end());
  options.set_memory_bytes(request.memory_bytes());
  options.set_max_attempts(request.max_attempts() == 0 ? kUsualAttempts : request.max_attempts());
  options.set_redundancy(request.redundancy());
  options.set_frame_order(request.frame_order() == 0 ? v1::FRAME_ORDER_SEQUENTIAL
                                                     : request.frame_order());
  return options;
}

/// What is stored of a new job, but for what its document says.
StoredJob new_row(const v1::SubmitRequest& request, const v1::Job& options, bool owner_proven) {
  StoredJob row;
  row.key = request.idempotency_key();
  row.spec = request.spec().SerializeAsString();
  row.owner = request.owner();
  row.owner_proven = owner_proven;
  row.priority = request.priority();
  row.options = options.SerializeAsString();
  row.submitted_ms = core::wall_ms();
  return row;
}

}  // namespace

grpc::Status JobIntake::submit(const v1::SubmitRequest& request, bool owner_proven,
                               v1::SubmitResponse& response) {
  const std::string& key = request.idempotency_key();
  if (!key.empty() && (key.size() < 16 || key.size() > 64)) {
    return wrong("idempotency_key has to have 16 to 64 characters");
  }
  // What is here already is answered, whatever else could be said against a new one.
  const auto known = context_.store->job_of_key(key);
  if (!known) return farm::unavailable(known.error());
  if (*known) return answer_with(**known, true, response);
  if (const grpc::Status sane = check_words(request); !sane.ok()) return sane;
  const auto options = read_options(request);
  if (!options) return wrong(options.error().message);
  const auto files = files_of(request.spec());
  if (!files) return wrong(files.error().message);
  // Before its files are missed: who may have no other job need not upload them.
  if (const grpc::Status may = may_have_one_more(request.owner()); !may.ok()) return may;
  if (const grpc::Status room = disk_.admit(0); !room.ok()) return room;
  if (const grpc::Status here = files_are_here(request.spec()); !here.ok()) return here;
  auto active = [&]() -> std::optional<core::Result<std::unique_ptr<ActiveJob>>> {
    // A long document takes seconds: others' jobs are removed and tried again meanwhile.
    const auto document =
        context_.documents.read(request.spec(), kReadingPatience, request.owner());
    if (!document) return std::nullopt;
    if (!*document) return document->error();
    if (!core::may_give_light((**document)->job)) response.add_warnings(core::kNothingGivesLight);
    return make_active_job(new_row(request, *options, owner_proven), request.spec(), ***document,
                           *context_.assets, context_.options.film_memory);
  }();
  if (!active) return others_are_read();
  const auto one = context_.wait_for_submissions();
  if (!one) return others_submit();
  if (const grpc::Status may = may_have_one_more(request.owner()); !may.ok()) return may;
  // What was not needed may have been removed meanwhile; from here on nothing is.
  if (const grpc::Status here = files_are_here(request.spec()); !here.ok()) return here;
  if (!*active) return wrong(active->error().message);
  return take_in(std::move(**active), request.owner(), response, *files);
}

/// Stores a new job, which nobody else knows yet, and begins with it.
grpc::Status JobIntake::take_in(std::unique_ptr<ActiveJob> active, const std::string& owner,
                                v1::SubmitResponse& response,
                                const std::vector<core::AssetRecord>& files) {
  const JobRoom more{active->numbers.size(), active->bytes};
  if (const grpc::Status room = has_room_for(owner, more); !room.ok()) return room;
  const auto added = [&] {
    const NotSharedYet alone;
    return context_.store->add_job(active->stored);
  }();
  if (!added) return farm::unavailable(added.error());
  core::failpoint("job-stored");
  for (const core::AssetRecord& file : files) unclaimed_.remove(file.sha256);
  if (!added->existed) {
    note_submission(*active, added->id, response);
    if (core::Status started = starter_.start(std::move(active), {}); !started) {
      // Nothing was promised yet.
      (void)context_.store->remove_job(added->id);
      return farm::unavailable(started.error());
    }
  }
  if (added->existed) response.clear_warnings();
  return answer_with(added->id, added->existed, response);
}

/// What the log of a new job begins with.
void JobIntake::note_submission(ActiveJob& active, uint64_t id,
                                const v1::SubmitResponse& response) {
  const NotSharedYet alone;
  active.id = JobId{id};
  active.stored.id = id;
  const std::string& owner = active.stored.owner;
  jobs_.note(active, v1::LOG_LEVEL_INFO, std::nullopt, {},
             fmt::format("submitted by {}: {}", owner.empty() ? "nobody in particular" : owner,
                         core::counted(active.numbers.size(), "frame")));
  for (const std::string& warning : response.warnings()) {
    jobs_.note(active, v1::LOG_LEVEL_WARNING, std::nullopt, {}, warning);
  }
}

grpc::Status JobIntake::answer_with(uint64_t id, bool existed, v1::SubmitResponse& response) {
  v1::GetJobResponse now;
  const grpc::Status got = queries_.get(id, std::nullopt, now);
  *response.mutable_job() = now.job();
  response.set_existed(existed);
  return got;
}

/// Whether the owner may have one more open job.
grpc::Status JobIntake::may_have_one_more(const std::string& owner) {
  uint64_t open = 0;
  uint64_t not_stored_ns = 0;
  {
    const StateLock lock(context_.mutex);
    for (const auto& [id, active] : jobs_.all()) {
      if (active->stored.owner != owner) continue;
      not_stored_ns += active->stored.core_ns - active->core_ns_stored;
      if (!active->ending) ++open;
    }
    for (const auto& [id, job] : jobs_.waiting()) {
      if (job.owner == owner) ++open;
    }
    for (const auto& [id, job] : jobs_.recovering()) {
      if (job.owner == owner && !jobs_.waiting().contains(id)) ++open;
    }
  }
  if (const grpc::Status may = quotas_.may_add_job(owner, open); !may.ok()) return may;
  if (!quotas_.limits_core_hours()) return grpc::Status::OK;
  const int64_t since = core::wall_ms() - std::chrono::milliseconds(kCoreHoursWindow).count();
  const auto stored_ns = context_.store->core_ns_of(owner, since);
  if (!stored_ns) return farm::unavailable(stored_ns.error());
  return quotas_.may_render(owner, *stored_ns + not_stored_ns);
}

/// Whether the memory that open jobs may take holds more of the owner.
grpc::Status JobIntake::has_room_for(const std::string& owner, const JobRoom& more) const {
  JobRoom his = more;
  JobRoom all = more;
  {
    const StateLock lock(context_.mutex);
    for (const auto& [id, active] : jobs_.all()) {
      const JobRoom one{active->numbers.size(), active->bytes};
      add(one, all);
      if (active->stored.owner == owner) add(one, his);
    }
    for (const auto& [id, job] : jobs_.recovering()) {
      add(job.room, all);
      if (job.owner == owner) add(job.room, his);
    }
  }
  const JobRoom& most = context_.options.job_room;
  if (const grpc::Status may = quotas_.may_hold(owner, his, most); !may.ok()) return may;
  return all.frames <= most.frames && all.bytes <= most.bytes ? grpc::Status::OK : no_room();
}

/// FAILED_PRECONDITION, naming those files of a job (which files_of has accepted) that are not.
grpc::Status JobIntake::files_are_here(const v1::JobSpec& spec) {
  v1::ErrorDetail missing;
  size_t count = 0;
  for (const v1::JobFile& file : spec.files()) {
    if (is_stored(file, *context_.assets)) continue;
    if (++count <= kMostMissingListed) missing.add_missing(file.sha256());
  }
  if (count == 0) return grpc::Status::OK;
  return farm::wire_status(grpc::StatusCode::FAILED_PRECONDITION,
                           fmt::format("{} of the job's files are not here yet", count), missing);
}

/// Waits for what is left of a job whose end is being stored.
grpc::Status JobIntake::wait_until_left(uint64_t id, Duration patience) {
  const TimePoint end = std::chrono::steady_clock::now() + patience;
  if (jobs_.wait_until_left(id, end, context_.stop)) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           fmt::format("the end of job {} is still being stored", id),
                           std::chrono::seconds(1));
}

void JobIntake::retry(uint64_t id, const JobReply& then) {
  v1::Job now;
  // A long document takes seconds, and others submit meanwhile.
  std::optional<JobRead> read = read_ahead(id);
  if (read && read->obstacle == Obstacle::others_are_read) return then(others_are_read(), now);
  // What is left of a job may take its time, and others submit meanwhile.
  if (read) {
    if (const grpc::Status left = wait_until_left(id, kLeavePatience); !left.ok())
      return then(left, now);
  }
  auto one = context_.wait_for_submissions();
  if (!one) return then(others_submit(), now);
  bool open = false;
  {
    Turn turn(dispatcher_);
    ActiveJob* active = jobs_.find(id);
    // The scheduler lets go of a job an instant before its end is seen here.
    open =
        active != nullptr && (active->making_videos || dispatcher_.scheduler().knows(active->id));
    if (open) {
      jobs_.note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {}, "failed frames are rendered again");
      turn.tell(FramesRetried{active->id});
      records_.when_done(id, then);
    }
  }
  if (context_.stop) records_.answer_late({});
  if (open) return;
  const grpc::Status reopened = reopen(id, std::move(read), std::move(one), now);
  then(reopened, now);
}

/// Reads a job that has ended. What is wrong with it is told later.
std::optional<JobRead> JobIntake::read_ahead(uint64_t id) {
  const auto stored = context_.store->job(id);
  if (!stored || !*stored || !has_ended((*stored)->state)) return std::nullopt;
  return recovery_.read(id);
}

/// A job that has ended is open again. Lets go of `one` once nobody else can recover or remove it.
grpc::Status JobIntake::reopen(uint64_t id, std::optional<JobRead> read,
                               std::unique_lock<std::timed_mutex> one, v1::Job& now) {
  if (const grpc::Status left = wait_until_left(id, {}); !left.ok()) return left;
  StoredJob job;
  if (const grpc::Status may = may_reopen(id, job); !may.ok()) return may;
  if (!read) {
    return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                             fmt::format("job {} has ended just now", id), std::chrono::seconds(1));
  }
  const StoredJob before = job;
  job.state = StoredState::running;
  job.ended_ms = 0;
  job.reason.clear();
  const auto mine = [&] {
    const StateLock lock(context_.mutex);
    return jobs_.begin_recovery(id, {job.owner, {job.frames, memory_of(job)}});
  }();
  if (!mine) return being_recovered(id);
  if (core::Status noted = context_.store->update_job(job); !noted)
    return farm::unavailable(noted.error());
  one.unlock();  // what is in its films and outputs may be much
  const core::Status forgotten = context_.store->forget_failed_frames(id);
  const core::Status recovered =
      forgotten ? recovery_.recover(id, std::move(*read), "goes on: somebody has retried it")
                : forgotten;
  if (!recovered) {
    job = before;  // done, if only some of its pictures are suspect
    job.reason = "could not be retried: " + recovered.error().message;
    // Where this fails too it is tried again at the next start.
    (void)context_.store->update_job(job);
    if (!forgotten) return farm::unavailable(forgotten.error());
    return {grpc::StatusCode::FAILED_PRECONDITION, recovered.error().message};
  }
  v1::GetJobResponse got;
  const grpc::Status status = queries_.get(id, std::nullopt, got);
  now = got.job();
  return status;
}

/// Whether something is left to do of a job that has ended, which is read into `job`.
grpc::Status JobIntake::may_reopen(uint64_t id, StoredJob& job) {
  auto stored = context_.store->job(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  job = std::move(**stored);
  if (!has_ended(job.state)) return why_not_open(*context_.store, id);
  if (const grpc::Status may = may_have_one_more(job.owner); !may.ok()) return may;
  const auto suspect = context_.store->suspect_frames(id, 1);
  if (!suspect) return farm::unavailable(suspect.error());
  if (job.state == StoredState::done && suspect->empty()) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            fmt::format("job {} is done: there is nothing to render again", id)};
  }
  return has_room_for(job.owner, {job.frames, memory_of(job)});
}

/// Whether the job has ended, and what is left of it is stored.
grpc::Status JobIntake::may_remove(uint64_t id, Duration patience) {
  {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(id);
    if (active != nullptr && !active->ending) {
      return {grpc::StatusCode::FAILED_PRECONDITION,
              fmt::format("job {} has not ended: cancel it first", id)};
    }
    if (jobs_.recovering().contains(id)) return being_recovered(id);
  }
  return wait_until_left(id, patience);
}

grpc::Status JobIntake::remove(uint64_t id) {
  if (const grpc::Status may = may_remove(id, kLeavePatience); !may.ok()) return may;
  const auto stored = context_.store->job(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  // Its files have been of use until now: they stay for a while, should it come again. They may be
  // many, and others submit meanwhile.
  v1::JobSpec spec;
  if (spec.ParseFromString((*stored)->spec)) {
    for (const v1::JobFile& file : spec.files()) {
      if (const auto digest = farm::digest_from_wire(file.sha256())) {
        context_.assets->touch(core::to_hex(*digest));
      }
    }
  }
  {
    const auto one = context_.wait_for_submissions();
    if (!one) return others_submit();
    // Somebody may have retried or removed it.
    if (const grpc::Status may = may_remove(id, {}); !may.ok()) return may;
    const auto still = context_.store->state(id);
    if (const grpc::Status there = job_is_there(id, still); !there.ok()) return there;
    if (core::Status gone = forget(id); !gone) return farm::unavailable(gone.error());
  }
  timelines_.forget(id);
  videos_.forget(id);
  sweeper_.job_removed(id, (*stored)->owner);
  return grpc::Status::OK;
}

/// Has the store forget the job.
core::Status JobIntake::forget(uint64_t id) {
  constexpr uint64_t kFiles = 1000;  // others wait
  core::Status removed = context_.store->remove_job(id);
  if (removed) return removed;
  // A full disk cannot even store that the job is gone: what is to go makes the room.
  context_.films->remove(id, kFiles);
  remove_some(context_.output_folder(id), kFiles);
  return context_.store->remove_job(id);
}

}  // namespace hyades::coordinator
