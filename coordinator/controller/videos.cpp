// Videos, which are made when all frames of a job are done.
#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/finisher/finish_process.h"
#include "core/base/failpoint.h"
#include "core/job/output_path.h"
#include "core/job/video.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kVideoAgain = std::chrono::seconds(1);

std::string in_words(const std::vector<core::VideoDesc>& videos) {
  std::string names;
  for (const core::VideoDesc& video : videos) names += (names.empty() ? "" : ", ") + video.file;
  return names;
}

}  // namespace

/// The job ends when its videos are made. With the lock.
void Controller::begin_videos(ActiveJob& active) {
  active.making_videos = true;
  note(active, v1::LOG_LEVEL_INFO, std::nullopt, {},
       fmt::format("all frames are done; to be made of them: {}", in_words(active.videos())));
  videos_due_.push_back(active.id);
  video_wake_.notify_one();
}

/// With the lock.
void Controller::cancel_videos(ActiveJob& active) {
  std::erase(videos_due_, active.id);
  if (making_videos_of_ == active.id) video_stop_ = true;
  active.making_videos = false;
  end_job(active, true, {});
}

/// A thread of its own: what takes minutes must not hold up frames.
void Controller::video_loop() {
  const auto is_asked = [this] {
    return std::any_of(asked_videos_.begin(), asked_videos_.end(), [](const AskedVideo& video) {
      return video.state == AskedVideo::State::waiting;
    });
  };
  std::unique_lock lock(mutex_);
  for (;;) {
    making_videos_of_.reset();
    video_wake_.wait(lock, [&] { return stop_ || !videos_due_.empty() || is_asked(); });
    if (stop_) return;
    if (videos_due_.empty()) {
      make_asked_video(lock);
    } else {
      const JobId job = videos_due_.front();
      videos_due_.pop_front();
      make_job_videos(lock, job);
    }
    if (stop_) return;
  }
}

/// The job's own videos. With the lock, which is let go of meanwhile.
void Controller::make_job_videos(std::unique_lock<std::mutex>& lock, JobId job) {
  ActiveJob* active = active_job(job);
  if (active == nullptr || !active->making_videos) return;
  making_videos_of_ = job;
  video_stop_ = false;
  const auto id = static_cast<uint64_t>(job);
  const std::vector<core::VideoDesc> videos = active->videos();
  const core::VideoFrames frames =
      core::video_frames(active->read.job, output_folder(id), active->numbers);
  lock.unlock();
  const core::Status made = make_videos(id, videos, frames);
  mind_disk();
  lock.lock();
  if (stop_) return;
  active = active_job(job);
  if (video_stop_ || active == nullptr) return;  // cancelled, and perhaps taken up again
  if (!made && disk_.level() != DiskLevel::roomy) {
    active->trouble = "its video waits for room on the disk: " + made.error().message;
    active->touch();
    videos_due_.push_back(job);
    video_wake_.wait_for(lock, kVideoAgain, [&] { return stop_.load(); });
    return;
  }
  active->making_videos = false;
  active->trouble.clear();
  if (made) {
    note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {},
         fmt::format("{} made of {} frames", in_words(videos), frames.numbers.size()));
    end_job(*active, false, {});
  } else {
    const std::string why =
        made.error().message + "; 'fetch' brings the frames' pictures, 'retry' tries again";
    note(*active, v1::LOG_LEVEL_ERROR, std::nullopt, {}, why);
    end_job(*active, false, why);
  }
}

/// Those that are not there yet. Without the lock.
core::Status Controller::make_videos(uint64_t id, const std::vector<core::VideoDesc>& videos,
                                     const core::VideoFrames& frames) {
  for (const core::VideoDesc& video : videos) {
    const auto there = store_->output(id, video.file);
    if (!there) return there.error();
    if (!*there) {
      if (core::Status made = make_video(id, video, frames); !made) return made;
    }
    // The pictures are not told any more: what an earlier run left goes too.
    std::error_code ignored;
    std::filesystem::remove_all(output_folder(id) + "/" + core::video_folder(video), ignored);
  }
  return {};
}

core::Status Controller::make_video(uint64_t id, const core::VideoDesc& video,
                                    const core::VideoFrames& frames) {
  const int64_t begun_us = wall_us();
  const auto files =
      run_video_maker(options_.finisher, fmt::format("{}/tmp/{}-video", options_.folder, id),
                      {video, frames}, video_stop_);
  if (!files) return files.error();
  std::vector<StoredOutput> made;
  for (const FinishedFile& file : *files) {
    const auto digest = farm::digest_from_hex(file.sha256);
    made.push_back({file.path, frames.numbers.back(), file.size,
                    digest ? farm::to_wire(*digest) : std::string()});
  }
  core::failpoint("video-made");
  core::Status stored = store_->change_outputs(id, {core::video_folder(video)}, made);
  core::failpoint("video-stored");
  const std::lock_guard lock(mutex_);
  timelines_.note(id, {v1::TimelineStep::KIND_VIDEO, {}, 0, {}, begun_us, wall_us()});
  return stored;
}

bool Controller::is_for_video(uint64_t job, const std::string& path) const {
  const std::lock_guard lock(mutex_);
  const auto active = jobs_.find(JobId{job});
  if (active == jobs_.end()) return false;
  const std::vector<core::VideoDesc>& videos = active->second->videos();
  return std::any_of(videos.begin(), videos.end(), [&](const core::VideoDesc& video) {
    return path.starts_with(core::video_folder(video) + "/");
  });
}

/// Where a video is missing, or one of the frames is `repeated`, it is made anew, of all frames:
/// those of the `done` ones whose pictures went when it was made are repeated too.
core::Status Controller::repeat_for_videos(const ActiveJob& active,
                                           const std::vector<int32_t>& done,
                                           std::set<int32_t>& repeated) {
  const uint64_t id = active.stored.id;
  const auto outputs = store_->outputs(id, 0, UINT32_MAX);
  if (!outputs) return outputs.error();
  std::set<std::string> paths;
  for (const StoredOutput& output : *outputs) paths.insert(output.path);
  // What one video repeats costs the others too.
  for (size_t before = repeated.size() + 1; before != repeated.size();) {
    before = repeated.size();
    for (const core::VideoDesc& video : active.videos()) {
      if (repeated.empty() && paths.contains(video.file)) continue;
      if (core::Status gone = store_->change_outputs(id, {video.file}, {}); !gone) return gone;
      paths.erase(video.file);
      for (const int32_t number : done) {
        if (!paths.contains(core::output_path(video.pictures, number))) repeated.insert(number);
      }
    }
  }
  return {};
}

}  // namespace hyades::coordinator
