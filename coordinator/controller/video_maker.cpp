#include "coordinator/controller/video_maker.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/job_records.h"
#include "coordinator/controller/not_found.h"
#include "coordinator/controller/stored_outputs.h"
#include "coordinator/finisher/finish_process.h"
#include "core/base/failpoint.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "core/job/made_file.h"
#include "core/job/output_path.h"
#include "core/job/video.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostWaiting = 64;
constexpr size_t kMostWaitingOfOne = 8;
constexpr size_t kMostKept = 200;  ///< that were asked for, with what became of them
/// Keys of videos that were asked for: others are of jobs.
constexpr uint64_t kAsked = uint64_t{1} << 63U;

bool is_over(const RequestedVideo& video) {
  return video.state == RequestedVideo::State::done || video.state == RequestedVideo::State::failed;
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

std::string in_words(const std::vector<core::VideoDesc>& videos) {
  std::string names;
  for (const core::VideoDesc& video : videos) names += (names.empty() ? "" : ", ") + video.file;
  return names;
}

}  // namespace

void VideoMaker::begin(ActiveJob& active) {
  active.making_videos = true;
  jobs_.note(active, v1::LOG_LEVEL_INFO, std::nullopt, {},
             fmt::format("all frames are done; to be made of them: {}", in_words(active.videos)));
  add(active);
}

void VideoMaker::add(const ActiveJob& active) {
  queue_.add(
      active.stored.id,
      [this, job = active.id, life = active.life] { return make_of_job(job, life); },
      active.stored.owner);
}

void VideoMaker::cancel(ActiveJob& active) {
  in_work_.break_off(active.stored.id);
  active.making_videos = false;
  records_.end(active, true, {});
}

void VideoMaker::forget(uint64_t job) {
  const StateLock lock(context_.mutex);
  for (RequestedVideo& video : asked_) {
    if (video.job != job || is_over(video)) continue;
    in_work_.break_off(kAsked | video.number);
    video.state = RequestedVideo::State::failed;
    video.reason = "the job was deleted";
  }
}

void VideoMaker::stop() {
  const StateLock lock(context_.mutex);
  in_work_.break_off_all();
}

bool VideoMaker::make_of_job(JobId job, uint64_t life) {
  const auto id = static_cast<uint64_t>(job);
  std::vector<core::VideoDesc> videos;
  core::VideoFrames frames;
  std::optional<TasksInWork::Task> in_work;
  {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(job);
    if (active == nullptr || active->life != life || !active->making_videos) return true;
    in_work.emplace(in_work_, id);
    videos = active->videos;
    frames = active->video_frames;
    frames.folder = context_.output_folder(id);
  }
  const core::Result<bool> made = make_one(id, videos, frames, in_work->stop());
  disk_.measure();
  const StateLock lock(context_.mutex);
  ActiveJob* active = jobs_.find(job);
  // Cancelled, and perhaps recovered since; or the controller ends.
  if (context_.stop || in_work->stop() || active == nullptr) return true;
  if (!made && disk_.level() != DiskLevel::roomy) {
    active->trouble = "its video waits for room on the disk: " + made.error().message;
    active->touch();
    return false;
  }
  active->trouble.clear();
  if (made && *made) {  // after others' turns
    add(*active);
    return true;
  }
  active->making_videos = false;
  if (made) {
    jobs_.note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {},
               fmt::format("{} made of {}", in_words(videos),
                           core::counted(frames.numbers.size(), "frame")));
    records_.end(*active, false, {});
  } else {
    const std::string why =
        made.error().message + "; 'fetch' brings the frames' pictures, 'retry' tries again";
    jobs_.note(*active, v1::LOG_LEVEL_ERROR, std::nullopt, {}, why);
    records_.end(*active, false, why);
  }
  return true;
}

/// Makes the first video that is not there yet; whether there are more.
core::Result<bool> VideoMaker::make_one(uint64_t id, const std::vector<core::VideoDesc>& videos,
                                        const core::VideoFrames& frames,
                                        const std::atomic<bool>& stop) {
  bool one = false;
  for (const core::VideoDesc& video : videos) {
    const auto there = context_.store->output(id, video.file);
    if (!there) return there.error();
    if (!*there && std::exchange(one, true)) return true;
    if (!*there) {
      const core::Status made =
          make(id, "video", {video, frames}, {core::video_folder(video)}, stop);
      if (!made) return made.error();
    }
    // The pictures are not told any more: what an earlier run left goes too.
    core::remove_made_folder(context_.output_folder(id), core::video_folder(video));
  }
  return false;
}

/// Has the video made and stored among the job's outputs, in the place of those that are `gone`
/// then. `scratch` tells its temporary folder from others of the job.
core::Status VideoMaker::make(uint64_t id, const std::string& scratch, const VideoTask& task,
                              const std::vector<std::string>& gone, const std::atomic<bool>& stop) {
  const int64_t begun_us = core::wall_us();
  const auto files = run_video_maker(
      context_.options.finisher, fmt::format("{}/tmp/{}-{}", context_.options.folder, id, scratch),
      task, stop);
  if (!files) return files.error();
  core::failpoint("video-made");
  core::Status stored =
      context_.store->change_outputs(id, gone, stored_outputs(*files, task.frames.numbers.back()));
  core::failpoint("video-stored");
  if (!stored) {  // the job is deleted, perhaps
    std::error_code ignored;
    std::filesystem::remove(task.frames.folder + "/" + task.video.file, ignored);
    return stored;
  }
  timelines_.note(id, {v1::TimelineStep::KIND_VIDEO, {}, 0, {}, begun_us, core::wall_us()});
  return {};
}

grpc::Status VideoMaker::ask(uint64_t id, const VideoRequest& request, RequestedVideo& asked) {
  if (const grpc::Status room = disk_.admit(0); !room.ok()) return room;
  const auto stored = context_.store->job(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  const auto frames = context_.store->frames(id);
  if (!frames) return farm::unavailable(frames.error());
  const auto paths = output_paths(*context_.store, id);
  if (!paths) return farm::unavailable(paths.error());
  std::vector<int32_t> done;
  for (const StoredFrame& frame : *frames) {
    if (frame.done) done.push_back(frame.frame);
  }
  auto document =
      context_.documents.read_stored((*stored)->spec, kReadingPatience, (*stored)->owner);
  if (!document) return others_are_read();
  if (!*document) return {grpc::StatusCode::FAILED_PRECONDITION, document->error().message};
  auto plan = plan_video((**document)->job, request, std::move(done), *paths);
  document.reset();
  if (!plan) return {grpc::StatusCode::FAILED_PRECONDITION, plan.error().message};
  plan->job = id;
  plan->frames.folder = context_.output_folder(id);
  const StateLock lock(context_.mutex);
  plan->owner = (*stored)->owner;
  size_t waiting = 0;
  size_t own = 0;
  for (const RequestedVideo& other : asked_) {
    waiting += is_over(other) ? 0 : 1;
    own += is_over(other) || other.owner != plan->owner ? 0 : 1;
    if (other.job != id || other.video.file != plan->video.file || is_over(other)) continue;
    asked = other;  // somebody was quicker, or asked twice
    return grpc::Status::OK;
  }
  if (waiting >= kMostWaiting || own >= kMostWaitingOfOne) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             "more videos wait to be made than may", std::chrono::seconds(30));
  }
  plan->number = next_asked_++;
  asked_.push_back(*plan);
  if (asked_.size() > kMostKept) {
    const auto oldest = std::find_if(asked_.begin(), asked_.end(), is_over);
    if (oldest != asked_.end()) asked_.erase(oldest);
  }
  asked = std::move(*plan);
  queue_.add(
      kAsked | asked.number,
      [this, number = asked.number] {
        make_asked(number);
        return true;
      },
      asked.owner);
  return grpc::Status::OK;
}

grpc::Status VideoMaker::asked(uint64_t id, std::vector<RequestedVideo>& videos) {
  const auto known = context_.store->state(id);
  if (const grpc::Status there = job_is_there(id, known); !there.ok()) return there;
  const StateLock lock(context_.mutex);
  for (const RequestedVideo& video : asked_) {
    if (video.job == id) videos.push_back(video);
  }
  return grpc::Status::OK;
}

void VideoMaker::make_asked(uint64_t number) {
  RequestedVideo video;
  std::optional<TasksInWork::Task> in_work;
  {
    const StateLock lock(context_.mutex);
    const auto asked = std::find_if(asked_.begin(), asked_.end(),
                                    [number](const auto& other) { return other.number == number; });
    if (context_.stop || asked == asked_.end() || is_over(*asked)) return;
    asked->state = RequestedVideo::State::making;
    video = *asked;
    in_work.emplace(in_work_, kAsked | number);
  }
  const core::Status done = make(video.job, fmt::format("asked-video-{}", number),
                                 {video.video, video.frames}, {}, in_work->stop());
  disk_.measure();
  asked_is_over(video, done);
}

void VideoMaker::asked_is_over(const RequestedVideo& video, const core::Status& done) {
  StoredLine line{core::wall_ms(),
                  done ? v1::LOG_LEVEL_INFO : v1::LOG_LEVEL_ERROR,
                  std::nullopt,
                  {},
                  done ? fmt::format("{} made of {}, as somebody asked", video.video.file,
                                     core::counted(video.frames.numbers.size(), "frame"))
                       : video.video.file + " could not be made: " + done.error().message};
  line.text = farm::wire_text(line.text);
  {
    const StateLock lock(context_.mutex);
    for (RequestedVideo& kept : asked_) {
      if (kept.number != video.number || is_over(kept)) continue;
      kept.state = done ? RequestedVideo::State::done : RequestedVideo::State::failed;
      if (!done) kept.reason = farm::wire_text(done.error().message);
    }
    if (context_.stop) return;
    if (ActiveJob* active = jobs_.find(video.job)) return active->note(std::move(line));
  }
  (void)context_.store->add_lines(video.job, {line});
}

}  // namespace hyades::coordinator
