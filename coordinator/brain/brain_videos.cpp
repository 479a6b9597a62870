// Videos, which are made when all frames of a job are done.
#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "coordinator/finisher/finish_process.h"
#include "core/base/failpoint.h"
#include "core/job/output_path.h"
#include "core/job/video.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kFilmAgain = std::chrono::seconds(1);

std::string in_words(const std::vector<core::VideoDesc>& videos) {
  std::string names;
  for (const core::VideoDesc& video : videos) names += (names.empty() ? "" : ", ") + video.file;
  return names;
}

}  // namespace

/// The job ends when its videos are made. With the lock.
void Brain::begin_filming(JobDesk& desk) {
  desk.filming = true;
  note(desk, v1::LOG_LEVEL_INFO, std::nullopt, {},
       fmt::format("all frames are done; to be made of them: {}", in_words(desk.videos())));
  to_film_.push_back(desk.id);
  film_wake_.notify_one();
}

/// With the lock.
void Brain::cancel_filming(JobDesk& desk) {
  std::erase(to_film_, desk.id);
  if (filming_ == desk.id) film_stop_ = true;
  desk.filming = false;
  end_job(desk, true, {});
}

/// A thread of its own: what takes minutes must not hold up frames.
void Brain::film_loop() {
  const auto is_asked = [this] {
    return std::any_of(asked_videos_.begin(), asked_videos_.end(), [](const AskedVideo& video) {
      return video.state == AskedVideo::State::waiting;
    });
  };
  std::unique_lock lock(mutex_);
  for (;;) {
    filming_.reset();
    film_wake_.wait(lock, [&] { return stop_ || !to_film_.empty() || is_asked(); });
    if (stop_) return;
    if (to_film_.empty()) {
      film_asked(lock);
    } else {
      const JobId job = to_film_.front();
      to_film_.pop_front();
      film_job(lock, job);
    }
    if (stop_) return;
  }
}

/// The job's own videos. With the lock, which is let go of meanwhile.
void Brain::film_job(std::unique_lock<std::mutex>& lock, JobId job) {
  JobDesk* desk = desk_of(job);
  if (desk == nullptr || !desk->filming) return;
  filming_ = job;
  film_stop_ = false;
  const auto id = static_cast<uint64_t>(job);
  const std::vector<core::VideoDesc> videos = desk->videos();
  const core::VideoFrames frames =
      core::video_frames(desk->read.job, output_folder(id), desk->numbers);
  lock.unlock();
  const core::Status made = make_videos(id, videos, frames);
  mind_disk();
  lock.lock();
  if (stop_) return;
  desk = desk_of(job);
  if (film_stop_ || desk == nullptr) return;  // cancelled, and perhaps taken up again
  if (!made && disk_.level() != DiskLevel::roomy) {
    desk->trouble = "its video waits for room on the disk: " + made.error().message;
    desk->touch();
    to_film_.push_back(job);
    film_wake_.wait_for(lock, kFilmAgain, [&] { return stop_.load(); });
    return;
  }
  desk->filming = false;
  desk->trouble.clear();
  if (made) {
    note(*desk, v1::LOG_LEVEL_INFO, std::nullopt, {},
         fmt::format("{} made of {} frames", in_words(videos), frames.numbers.size()));
    end_job(*desk, false, {});
  } else {
    const std::string why =
        made.error().message + "; 'fetch' brings the frames' pictures, 'retry' tries again";
    note(*desk, v1::LOG_LEVEL_ERROR, std::nullopt, {}, why);
    end_job(*desk, false, why);
  }
}

/// Those that are not there yet. Without the lock.
core::Status Brain::make_videos(uint64_t id, const std::vector<core::VideoDesc>& videos,
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

core::Status Brain::make_video(uint64_t id, const core::VideoDesc& video,
                               const core::VideoFrames& frames) {
  const int64_t begun_us = wall_us();
  const auto files =
      run_video_maker(options_.finisher, fmt::format("{}/tmp/{}-video", options_.folder, id),
                      {video, frames}, film_stop_);
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

bool Brain::is_for_video(uint64_t job, const std::string& path) const {
  const std::lock_guard lock(mutex_);
  const auto desk = desks_.find(JobId{job});
  if (desk == desks_.end()) return false;
  const std::vector<core::VideoDesc>& videos = desk->second->videos();
  return std::any_of(videos.begin(), videos.end(), [&](const core::VideoDesc& video) {
    return path.starts_with(core::video_folder(video) + "/");
  });
}

/// Where a video is missing, or one of the frames is `repeated`, it is made anew, of all frames:
/// those of the `done` ones whose pictures went when it was made are repeated too.
core::Status Brain::repeat_for_videos(const JobDesk& desk, const std::vector<int32_t>& done,
                                      std::set<int32_t>& repeated) {
  const uint64_t id = desk.stored.id;
  const auto outputs = store_->outputs(id, 0, UINT32_MAX);
  if (!outputs) return outputs.error();
  std::set<std::string> paths;
  for (const StoredOutput& output : *outputs) paths.insert(output.path);
  // What one video repeats costs the others too.
  for (size_t before = repeated.size() + 1; before != repeated.size();) {
    before = repeated.size();
    for (const core::VideoDesc& video : desk.videos()) {
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
