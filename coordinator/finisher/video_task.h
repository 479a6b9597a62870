#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/video.h"

namespace hyades::coordinator {

// Making a video is work for a process of its own too (finish_task.h): the coordinator writes
// video.json, starts `PROGRAM video FOLDER`, and reads result.json.

/// A video to be made of frames whose pictures are there.
struct VideoTask {
  core::VideoDesc video;
  core::VideoFrames frames;
};

/// The paths of the files that the task makes, below VideoFrames::folder.
std::vector<std::string> files_of(const VideoTask& task);

/// Writes the task into the folder, and reads it there.
core::Status write_video_task(const std::string& folder, const VideoTask& task);
core::Result<VideoTask> read_video_task(const std::string& folder);

}  // namespace hyades::coordinator
