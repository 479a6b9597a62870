#pragma once

#include <cstdint>
#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::core {

/// Whether a mesh has a file for each frame: a name with the frame's number in place of each run of
/// #, as outputs have (output_path).
bool is_mesh_sequence(const std::string& file);

/// The file of a mesh at `time`, in whose frame it lies; `file` itself where there is only one.
std::string mesh_file_at(const std::string& file, const JobTime& time);

/// Whether `file` is one of the sequence `pattern`, of whatever frame.
bool is_of_sequence(const std::string& pattern, const std::string& file);

/// Whether frames of the job look at the meshes of the frame after them: for what happens while the
/// shutter is open, or for the motion layer.
bool looks_at_next_frame(const Job& job);

/// Opens the files of a sequence that the job's frames look at, so that whoever records what a job
/// opens knows them. The one after a frame may be missing, if it is no frame of the job: the mesh
/// then stands still. Error: the first file that cannot be opened, with its frame.
Status open_mesh_sequence(const Job& job, const std::string& pattern, AssetResolver& assets);

}  // namespace hyades::core
