#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/film/film.h"
#include "core/film/film_info.h"
#include "core/job/job.h"

namespace hyades::coordinator {

// Finishing a frame (tone map, encode, write) is work for a process of its own, so that neither its
// memory nor a crash is the coordinator's. The two speak through a folder: the coordinator writes
// task.json and film.bin, starts `PROGRAM finish FOLDER`, and reads result.json.

/// What is to be made of a film.
struct FinishTask {
  core::FilmInfo info;
  std::vector<core::OutputDesc> outputs;
  std::string film;    ///< where the film itself goes, #### for the frame; empty: nowhere
  std::string folder;  ///< where outputs go
  std::optional<core::ColorDesc> color;  ///< once read, `config` lies in the task's folder
  /// The configuration and what it names, by their references in the job.
  std::vector<std::pair<std::string, core::Bytes>> color_files;
};

/// The path of a file below `folder` as results have it.
std::string told_path(const std::string& folder, const std::string& path);
/// The paths of the files that the task makes, below FinishTask::folder.
std::vector<std::string> files_of(const FinishTask& task);

/// A file that was made.
struct FinishedFile {
  std::string path;  ///< below FinishTask::folder
  uint64_t size = 0;
  std::string sha256;  ///< hexadecimal
};

/// Writes the task and its film into the folder.
core::Status write_finish_task(const std::string& folder, const FinishTask& task,
                               const core::Film& film);
/// Reads what write_finish_task() has written, but for color_files, whose files are there.
core::Result<FinishTask> read_finish_task(const std::string& folder);
core::Result<core::Film> read_finish_film(const std::string& folder);
/// Tells what has been made; for the process that finishes.
core::Status write_finish_result(const std::string& folder, const std::vector<FinishedFile>& files);
/// What has been made below `outputs`. The process that tells it may have been taken over by what a
/// job brings: an error where it is not of `files` alone, each once, or they are not as it says.
core::Result<std::vector<FinishedFile>> read_finish_result(const std::string& folder,
                                                           const std::string& outputs,
                                                           const std::vector<std::string>& files);

}  // namespace hyades::coordinator
