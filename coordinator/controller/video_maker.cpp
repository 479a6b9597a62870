#include "coordinator/controller/video_maker.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <limits>
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
constexpr uint32_t kRowsAtOnce = 1000;

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
  due_.push_back(active.id);
  queue_.add(0, [this] { return make_next(); });
}

void VideoMaker::cancel(ActiveJob& active) {
  std::erase(due_, active.id);
  if (in_work_ == active.id) stop_ = true;
  active.making_videos = false;
  records_.end(active, true, {});
}

void VideoMaker::stop() {
  const StateLock lock(context_.mutex);  // or a video that just begins would take it back
  stop_ = true;
}

std::string VideoMaker::owner_of(JobId job) const {
  const ActiveJob* active = jobs_.find(job);
  return active == nullptr ? std::string() : active->stored.owner;
}

/// The next one: of the owner whose videos have lately taken least time; of one owner's those of
/// jobs come first, and then those that were asked for earlier.
VideoMaker::Next VideoMaker::next() {
  const auto now = std::chrono::steady_clock::now();
  Next best;
  double least = std::numeric_limits<double>::infinity();
  for (const JobId job : due_) {
    std::string owner = owner_of(job);
    const double used = shares_.used(owner, now);
    if (used >= least) continue;
    best = {job, nullptr, std::move(owner)};
    least = used;
  }
  for (RequestedVideo& video : asked_) {
    if (video.state != RequestedVideo::State::waiting) continue;
    const double used = shares_.used(video.owner, now);
    if (used >= least) continue;
    best = {std::nullopt, &video, video.owner};
    least = used;
  }
  return best;
}

/// False: a job's wait, to be tried again.
bool VideoMaker::make_next() {
  JobId job{};
  RequestedVideo asked;
  std::string owner;
  {
    const StateLock lock(context_.mutex);
    if (context_.stop) return true;
    in_work_.reset();
    const Next what = next();
    owner = what.owner;
    stop_ = false;
    if (what.job) {
      job = *what.job;
      std::erase(due_, job);
    } else if (what.asked != nullptr) {
      what.asked->state = RequestedVideo::State::making;
      asked = *what.asked;
    } else {
      return true;
    }
  }
  const auto begun = std::chrono::steady_clock::now();
  bool over = true;
  if (asked.number == 0) {
    over = make_of_job(job);
  } else {
    make_asked(asked);
  }
  const auto now = std::chrono::steady_clock::now();
  const StateLock lock(context_.mutex);
  shares_.use(owner, std::chrono::duration<double>(now - begun).count(), now);
  return over;
}

bool VideoMaker::make_of_job(JobId job) {
  const auto id = static_cast<uint64_t>(job);
  std::vector<core::VideoDesc> videos;
  core::VideoFrames frames;
  {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(job);
    if (active == nullptr || !active->making_videos) return true;
    in_work_ = job;
    stop_ = context_.stop.load();
    videos = active->videos;
    frames = active->video_frames;
    frames.folder = context_.output_folder(id);
  }
  const core::Result<bool> made = make_one(id, videos, frames);
  disk_.measure();
  const StateLock lock(context_.mutex);
  ActiveJob* active = jobs_.find(job);
  // Cancelled, and perhaps recovered since; or the controller ends.
  if (context_.stop || stop_ || active == nullptr) return true;
  if (!made && disk_.level() != DiskLevel::roomy) {
    active->trouble = "its video waits for room on the disk: " + made.error().message;
    active->touch();
    due_.push_back(job);
    return false;
  }
  active->trouble.clear();
  if (made && *made) {  // after others' turns
    due_.push_back(job);
    queue_.add(0, [this] { return make_next(); });
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
                                        const core::VideoFrames& frames) {
  bool one = false;
  for (const core::VideoDesc& video : videos) {
    const auto there = context_.store->output(id, video.file);
    if (!there) return there.error();
    if (!*there && std::exchange(one, true)) return true;
    if (!*there) {
      const core::Status made = make(id, "video", {video, frames}, {core::video_folder(video)});
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
                              const std::vector<std::string>& gone) {
  const int64_t begun_us = core::wall_us();
  const auto files = run_video_maker(
      context_.options.finisher, fmt::format("{}/tmp/{}-{}", context_.options.folder, id, scratch),
      task, stop_);
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
  queue_.add(0, [this] { return make_next(); });
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

void VideoMaker::make_asked(const RequestedVideo& video) {
  const core::Status done = make(video.job, "asked-video", {video.video, video.frames}, {});
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
      if (kept.number != video.number) continue;
      kept.state = done ? RequestedVideo::State::done : RequestedVideo::State::failed;
      if (!done) kept.reason = farm::wire_text(done.error().message);
    }
    if (context_.stop) return;
    if (ActiveJob* active = jobs_.find(video.job)) return active->note(std::move(line));
  }
  (void)context_.store->add_lines(video.job, {line});
}

}  // namespace hyades::coordinator
