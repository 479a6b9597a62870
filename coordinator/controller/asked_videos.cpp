// Videos that somebody asks for, of jobs that have none, or not this one.
#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/counted.h"
#include "coordinator/controller/not_there.h"
#include "coordinator/finisher/finish_process.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostWaiting = 16;
/// That are remembered, with what became of them.
constexpr size_t kMostKept = 200;
constexpr uint32_t kRowsAtOnce = 1000;

bool is_over(const AskedVideo& video) {
  return video.state == AskedVideo::State::done || video.state == AskedVideo::State::failed;
}

/// The paths of all outputs of a job.
core::Result<std::vector<std::string>> output_paths(JobStore& store, uint64_t job) {
  std::vector<std::string> paths;
  for (uint64_t seen = 0;;) {
    auto outputs = store.outputs(job, seen, kRowsAtOnce);
    if (!outputs) return outputs.error();
    if (outputs->empty()) return paths;
    seen = outputs->back().number;
    for (StoredOutput& output : *outputs) paths.push_back(std::move(output.path));
  }
}

}  // namespace

grpc::Status Controller::ask_for_video(uint64_t id, const VideoWish& wish, AskedVideo& asked) {
  if (const grpc::Status room = admit(0); !room.ok()) return room;
  const auto stored = store_->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return no_job(id);
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) {
    return {grpc::StatusCode::DATA_LOSS, "the job's record is damaged"};
  }
  const auto active = make_active_job(**stored, spec, *assets_, UINT64_MAX);
  if (!active) return {grpc::StatusCode::FAILED_PRECONDITION, active.error().message};
  const auto frames = store_->frames(id);
  if (!frames) return farm::unavailable(frames.error());
  const auto paths = output_paths(*store_, id);
  if (!paths) return farm::unavailable(paths.error());
  std::vector<int32_t> done;
  for (const StoredFrame& frame : *frames) {
    if (frame.done) done.push_back(frame.frame);
  }
  auto plan = plan_video((*active)->read.job, wish, std::move(done), *paths);
  if (!plan) return {grpc::StatusCode::FAILED_PRECONDITION, plan.error().message};
  plan->job = id;
  plan->frames.folder = output_folder(id);
  const std::lock_guard lock(mutex_);
  size_t waiting = 0;
  for (const AskedVideo& other : asked_videos_) {
    waiting += is_over(other) ? 0 : 1;
    if (other.job != id || other.video.file != plan->video.file || is_over(other)) continue;
    asked = other;  // somebody was quicker, or asked twice
    return grpc::Status::OK;
  }
  if (waiting >= kMostWaiting) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             "more videos wait to be made than may", std::chrono::seconds(30));
  }
  plan->number = next_asked_++;
  asked_videos_.push_back(*plan);
  if (asked_videos_.size() > kMostKept) {
    const auto oldest = std::find_if(asked_videos_.begin(), asked_videos_.end(), is_over);
    if (oldest != asked_videos_.end()) asked_videos_.erase(oldest);
  }
  asked = std::move(*plan);
  video_wake_.notify_one();
  return grpc::Status::OK;
}

grpc::Status Controller::asked_videos(uint64_t id, std::vector<AskedVideo>& videos) {
  const auto known = store_->state(id);
  if (!known) return farm::unavailable(known.error());
  if (!*known) return no_job(id);
  const std::lock_guard lock(mutex_);
  for (const AskedVideo& video : asked_videos_) {
    if (video.job == id) videos.push_back(video);
  }
  return grpc::Status::OK;
}

/// Makes the first of them that waits. With the lock, which is let go of meanwhile.
void Controller::make_asked_video(std::unique_lock<std::mutex>& lock) {
  const auto waits = [](const AskedVideo& v) { return v.state == AskedVideo::State::waiting; };
  const auto found = std::find_if(asked_videos_.begin(), asked_videos_.end(), waits);
  if (found == asked_videos_.end()) return;
  found->state = AskedVideo::State::making;
  const AskedVideo video = *found;
  const int64_t begun_us = wall_us();
  video_stop_ = false;
  lock.unlock();
  const auto files = run_video_maker(
      options_.finisher, fmt::format("{}/tmp/{}-asked-video", options_.folder, video.job),
      {video.video, video.frames}, video_stop_);
  core::Status done;
  if (files) {
    std::vector<StoredOutput> made;
    for (const FinishedFile& file : *files) {
      const auto digest = farm::digest_from_hex(file.sha256);
      made.push_back({file.path, video.frames.numbers.back(), file.size,
                      digest ? farm::to_wire(*digest) : std::string()});
    }
    done = store_->change_outputs(video.job, {}, made);
    if (!done) {  // the job is deleted, perhaps
      std::error_code ignored;
      std::filesystem::remove(video.frames.folder + "/" + video.video.file, ignored);
    }
  } else {
    done = files.error();
  }
  mind_disk();
  StoredLine line{wall_ms(),
                  done ? v1::LOG_LEVEL_INFO : v1::LOG_LEVEL_ERROR,
                  std::nullopt,
                  {},
                  done ? fmt::format("{} made of {}, as somebody asked", video.video.file,
                                     counted(video.frames.numbers.size(), "frame"))
                       : video.video.file + " could not be made: " + done.error().message};
  line.text = farm::wire_text(line.text);
  lock.lock();
  for (AskedVideo& kept : asked_videos_) {
    if (kept.number != video.number) continue;
    kept.state = done ? AskedVideo::State::done : AskedVideo::State::failed;
    if (!done) kept.reason = farm::wire_text(done.error().message);
  }
  if (done) {
    timelines_.note(video.job, {v1::TimelineStep::KIND_VIDEO, {}, 0, {}, begun_us, wall_us()});
  }
  if (stop_) return;
  if (ActiveJob* active = active_job(video.job)) {
    active->note(std::move(line));
  } else {
    lock.unlock();
    (void)store_->add_lines(video.job, {line});
    lock.lock();
  }
}

}  // namespace hyades::coordinator
