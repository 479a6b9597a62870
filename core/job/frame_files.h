#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::core {

/// Whether a name means a file for each frame: it has the frame's number in place of each run of #,
/// as outputs have (output_path).
bool is_file_sequence(const std::string& file);

/// The file at `time`, in whose frame it lies; `file` itself where there is only one.
std::string frame_file_at(const std::string& file, const JobTime& time);

/// Whether frames of the job look at the files of the frame after them: for what happens while the
/// shutter is open, or for the motion layer.
bool looks_at_next_frame(const Job& job);

/// The files of these sequences at which frames of the job look; of very many, a million or two.
std::set<std::string> sequence_files(const Job& job, const std::set<std::string>& patterns);

/// Opens the files of a job's sequences, so that whoever records what a job opens knows them. Each
/// is opened once, however many sequences it belongs to.
class FileSequenceOpener {
 public:
  FileSequenceOpener(const Job& job, AssetResolver& assets);

  /// The files of `pattern` that the job's frames look at; of the next frame's only where `files`
  /// says so and looks_at_next_frame(). The one after a frame may be missing, if
  /// it is no frame of the job: a mesh then stands still. Error: the first file that cannot be
  /// opened, with its frame; or all sequences together have more than a million files.
  Status open(const std::string& pattern, FrameFiles files);

 private:
  Status open_at(int32_t frame, std::string file);

  const FramesDesc& frames_;
  AssetResolver& assets_;
  bool ahead_;  ///< looks_at_next_frame
  std::set<std::string> opened_;
  uint64_t looked_for_ = 0;  ///< of all sequences
};

}  // namespace hyades::core
