// What clients want to know of jobs.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "core/film/film_exr.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kMostListed = 1000;
/// Answers to those who read slowly, or never, lie in memory: they are kept short.
constexpr size_t kMostFrameBytes = size_t{64} << 10U;
constexpr uint32_t kMostFramesAtOnce = 2000;

grpc::Status failed(const core::Error& error) {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE, error.message, std::chrono::seconds(1));
}

grpc::Status no_job(uint64_t id) {
  return {grpc::StatusCode::NOT_FOUND, fmt::format("there is no job {}", id)};
}

v1::Frame describe_over(const StoredFrame& frame, const StoredJob& job) {
  v1::Frame wire;
  wire.set_frame(frame.frame);
  wire.set_state(frame.done ? v1::FRAME_STATE_DONE : v1::FRAME_STATE_FAILED);
  wire.set_samples(job.frames > 0 ? job.samples / job.frames : 0);
  wire.set_samples_done(frame.done ? wire.samples() : 0);
  wire.set_reason(frame.reason);
  wire.set_worker_class(frame.worker_class);
  wire.set_restarts(frame.restarts);
  return wire;
}

/// Frames as far as they fit into one message.
class FramePage {
 public:
  explicit FramePage(google::protobuf::RepeatedPtrField<v1::Frame>& frames) : frames_(frames) {}
  bool full() const { return bytes_ > kMostFrameBytes; }
  void add(const v1::Frame& frame) {
    bytes_ += frame.ByteSizeLong() + kEnvelope;
    *frames_.Add() = frame;
  }

 private:
  google::protobuf::RepeatedPtrField<v1::Frame>& frames_;
  static constexpr size_t kEnvelope = 3;  // tag and length
  size_t bytes_ = 0;
};

std::map<int32_t, FrameNote>::const_iterator above(const std::map<int32_t, FrameNote>& frames,
                                                   std::optional<int32_t> after) {
  return after ? frames.upper_bound(*after) : frames.begin();
}

}  // namespace

v1::Job Brain::describe(const JobDesk& desk) const {
  v1::Job job = desk.describe(scheduler_.leased_units(desk.id));
  // Until its end is stored, it has not ended for anybody.
  if (desk.ending) job.set_state(v1::JOB_STATE_RUNNING);
  if (job.reason().empty()) job.set_reason(disk_.reason());
  return job;
}

grpc::Status Brain::list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  const uint32_t limit =
      request.limit() == 0 ? kMostListed : std::min(request.limit(), kMostListed);
  const auto jobs = store_->list(request.ended(), request.owner(), request.before(), limit);
  if (!jobs) return failed(jobs.error());
  const std::lock_guard lock(mutex_);
  for (const StoredJob& job : *jobs) {
    const JobDesk* desk = desk_of(job.id);
    *response.add_jobs() = desk != nullptr ? describe(*desk) : coordinator::describe(job);
  }
  if (jobs->size() == limit) response.set_next_before(jobs->back().id);
  return grpc::Status::OK;
}

grpc::Status Brain::get(uint64_t id, std::optional<int32_t> after, v1::GetJobResponse& response) {
  FramePage page(*response.mutable_frames());
  {
    const std::lock_guard lock(mutex_);
    if (const JobDesk* desk = desk_of(id)) {
      *response.mutable_job() = describe(*desk);
      for (auto it = above(desk->frames, after); it != desk->frames.end(); ++it) {
        response.set_more(page.full());
        if (page.full()) break;
        page.add(desk->describe_frame(it->first, it->second));
      }
      return grpc::Status::OK;
    }
  }
  const auto stored = store_->job(id);
  if (!stored) return failed(stored.error());
  if (!*stored) return no_job(id);
  *response.mutable_job() = coordinator::describe(**stored);
  const auto frames = store_->frames(id, after, kMostFramesAtOnce);
  if (!frames) return failed(frames.error());
  response.set_more(frames->size() == kMostFramesAtOnce);
  for (const StoredFrame& frame : *frames) {
    if (page.full()) {
      response.set_more(true);
      break;
    }
    page.add(describe_over(frame, **stored));
  }
  return grpc::Status::OK;
}

grpc::Status Brain::changes(uint64_t id, ToldOf& told, v1::WatchEvent& event, bool& ended) {
  ended = false;
  {
    const std::lock_guard lock(mutex_);
    if (const JobDesk* desk = desk_of(id)) {
      *event.mutable_job() = describe(*desk);
      if (!told.after) told.next_version = desk->version;
      FramePage page(*event.mutable_changed());
      for (auto it = above(desk->frames, told.after); it != desk->frames.end(); ++it) {
        if (told.version != 0 && it->second.version <= told.version) continue;
        if (page.full()) {
          event.set_more(true);
          return grpc::Status::OK;
        }
        page.add(desk->describe_frame(it->first, it->second));
        told.after = it->first;
      }
      told.version = told.next_version;
      told.after.reset();
      return grpc::Status::OK;
    }
  }
  if (!std::exchange(told.over, true)) told.after.reset();
  v1::GetJobResponse over;
  const grpc::Status status = get(id, told.after, over);
  if (!status.ok()) return status;
  if (over.frames_size() > 0) told.after = over.frames().rbegin()->frame();
  event.set_more(over.more());
  event.mutable_job()->Swap(over.mutable_job());
  event.mutable_changed()->Swap(over.mutable_frames());
  ended = true;
  return grpc::Status::OK;
}

uint64_t Brain::watch(uint64_t job, std::function<void()> poke) {
  const std::lock_guard lock(mutex_);
  watches_.emplace(next_watch_, Watch{job, 0, std::move(poke)});
  return next_watch_++;
}

void Brain::unwatch(uint64_t number) {
  const std::lock_guard lock(mutex_);
  watches_.erase(number);
}

/// Of a frame that is done; without the lock.
grpc::Status Brain::kept_film(uint64_t id, int32_t frame, const FilmTaker& then) {
  const auto stored = store_->job(id);
  if (!stored) return failed(stored.error());
  if (!*stored) return no_job(id);
  const auto outputs = store_->outputs(id, 0, UINT32_MAX);
  if (!outputs) return failed(outputs.error());
  for (const StoredOutput& output : *outputs) {
    if (output.frame != frame || !output.path.ends_with(".film.exr")) continue;
    auto file = core::read_film_exr(output_folder(id) + "/" + output.path);
    if (!file) return {grpc::StatusCode::DATA_LOSS, file.error().message};
    then(grpc::Status::OK, file->info, std::make_shared<const core::Film>(std::move(file->film)));
    return grpc::Status::OK;
  }
  return {grpc::StatusCode::FAILED_PRECONDITION,
          fmt::format("there is no film of frame {} any more; 'keep_films: true' in the job keeps "
                      "those of finished frames",
                      frame)};
}

grpc::Status Brain::film(uint64_t id, int32_t frame, FilmTaker then) {
  std::unique_lock lock(mutex_);
  JobDesk* desk = desk_of(id);
  if (desk == nullptr || desk->ending) {
    lock.unlock();
    return kept_film(id, frame, then);
  }
  const auto noted = desk->frames.find(frame);
  if (noted == desk->frames.end()) {
    return {grpc::StatusCode::NOT_FOUND, fmt::format("job {} has no frame {}", id, frame)};
  }
  if (noted->second.state == v1::FRAME_STATE_DONE) {
    lock.unlock();
    return kept_film(id, frame, then);
  }
  if (!desk->keeper) {
    return farm::retry_later(grpc::StatusCode::UNAVAILABLE, "nothing of the frame is there yet",
                             std::chrono::seconds(1));
  }
  core::FilmInfo info = desk->film_info(frame);
  info.worker_class = noted->second.worker_class;
  // The keeper's thread copies, as only it may look at films while they grow; what follows takes
  // its time, which should not be the keeper's.
  desk->keeper->call([this, keeper = desk->keeper.get(), frame, info, then = std::move(then)] {
    const auto film = keeper->film(frame);
    const auto copy = film ? std::make_shared<const core::Film>(*film) : nullptr;
    const std::lock_guard held(mutex_);
    chore([copy, info, then] {
      then(copy ? grpc::Status::OK
                : farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                                    "nothing of the frame is there yet", std::chrono::seconds(1)),
           info, copy);
    });
  });
  return grpc::Status::OK;
}

grpc::Status Brain::explain(uint64_t id, v1::ExplainResponse& response) {
  const std::lock_guard lock(mutex_);
  JobDesk* desk = desk_of(id);
  const auto say = [&](std::string text) { response.add_reasons(std::move(text)); };
  if (desk == nullptr) {
    const auto stored = store_->job(id);
    if (!stored) return failed(stored.error());
    if (!*stored) return no_job(id);
    switch ((*stored)->state) {
      case StoredState::done:
        say("it is done");
        break;
      case StoredState::cancelled:
        say("it was cancelled; 'retry' takes it up again");
        break;
      default:
        say("it is over, but not all of it is done: " + (*stored)->reason +
            "; 'retry' takes it up again");
    }
    return grpc::Status::OK;
  }
  if (disk_.level() != DiskLevel::roomy) {
    say(disk_.reason() +
        (disk_.level() == DiskLevel::full ? "; no units are leased and films have to wait"
                                          : "; no units are leased") +
        " until there is room again (deleting jobs that have ended makes some)");
  }
  if (!desk->trouble.empty()) say(desk->trouble);
  if (desk->stored.state == StoredState::paused) say("it is paused; 'resume' lets it go on");
  uint32_t active = 0;
  std::map<std::string, uint32_t> classes;
  for (const auto& [worker, seat] : seats_) {
    if (!seat.joined || seat.state != v1::WORKER_STATE_ACTIVE) continue;
    ++active;
    ++classes[seat.hello.worker_class()];
  }
  const std::string unmet = active > 0 ? unmet_needs(desk->stored) : std::string();
  if (active == 0) say("no worker is there that could take units");
  if (!unmet.empty()) say(unmet);
  uint32_t waiting = 0;
  uint32_t orphans = 0;
  for (const auto& [number, note] : desk->frames) {
    if (note.state == v1::FRAME_STATE_FINISHING) {
      say(fmt::format("frame {} is rendered; its outputs are being made", number));
    } else if (note.state == v1::FRAME_STATE_FAILED) {
      say(fmt::format("frame {} failed: {}", number, note.reason));
    } else if (note.state == v1::FRAME_STATE_WAITING) {
      ++waiting;
    } else if (note.state == v1::FRAME_STATE_RENDERING && active > 0 &&
               !note.worker_class.empty() && !classes.contains(note.worker_class)) {
      ++orphans;
      say(fmt::format(
          "frame {} was begun by workers of class {}, and none of them is there; it "
          "begins again with another class {} s after the last one went",
          number, note.worker_class.substr(0, 12),
          std::chrono::duration_cast<std::chrono::seconds>(options_.class_patience).count()));
    }
  }
  if (const uint32_t disputed = scheduler_.disputed_units(desk->id); disputed > 0) {
    say(
        fmt::format("{} units were rendered differently by two workers of one class and wait for "
                    "another worker of it to say who is right",
                    disputed));
  }
  for (std::string& still : still_units(desk->id)) say(std::move(still));
  const uint32_t leased = scheduler_.leased_units(desk->id);
  if (leased > 0) {
    say(fmt::format("{} units are being rendered", leased));
    if (desk->stored.max_workers > 0) {
      say(fmt::format("at most {} workers may render it at once", desk->stored.max_workers));
    }
  } else if (active > 0 && orphans == 0 && unmet.empty() &&
             desk->stored.state == StoredState::running) {
    for (const auto& [other, rival] : desks_) {
      if (other != desk->id && rival->stored.priority >= desk->stored.priority &&
          scheduler_.leased_units(other) > 0) {
        say(fmt::format("job {} ({}, priority {}) has the workers now", rival->stored.id,
                        rival->stored.name, rival->stored.priority));
      }
    }
    if (std::chrono::steady_clock::now() < adopting_until_) {
      say("the coordinator has just started and waits for its workers to come back");
    }
  }
  if (waiting > 0) say(fmt::format("{} frames wait for their turn", waiting));
  if (response.reasons().empty()) say("nothing stands in its way");
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
