#pragma once

#include <string>

#include "core/job/job.h"
#include "core/job/map_reader.h"

namespace hyades::core {

/// Complains where `file` has no #### though there are several frames; of a `video`: where it has.
void check_frame_marks(MapReader& reader, const SourceLocation& where, const std::string& file,
                       const FramesDesc& frames, bool video);

/// Complains where `file` is not below the output folder. A job says where below it its pictures
/// go; it has no say over the rest of the disk.
void check_inside_folder(MapReader& reader, const SourceLocation& where, const std::string& file);

/// Whether `file` can be written beside what the job writes already; complains if not.
bool has_own_place(MapReader& reader, const SourceLocation& where, const std::string& file,
                   const Job& job);

}  // namespace hyades::core
