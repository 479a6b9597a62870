#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/finish/video.h"
#include "core/job/job.h"

namespace hyades::cli {

/// Makes the job's videos of frames `numbers`, whose pictures lie below `folder`; says what it does
/// unless `quiet`. False, and why on standard error, where one could not be made: what they are
/// made of stays.
bool make_videos(const core::Job& job, const std::string& folder,
                 const std::vector<int32_t>& numbers, bool quiet);

/// Says that videos are not made of some of the job's frames, and what makes them.
void note_no_videos(const core::Job& job, const std::string& folder, const std::string& path);

}  // namespace hyades::cli
