#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/job.h"

namespace hyades::core {

/// Everything of `job` that decides the pixels of `frame`, one "path=value" per line in a fixed
/// order: floats by their bits, animated values at the moments of the shutter, files by the hash
/// that `assets` has for them. Not in it: the job's name and file, outputs, the frame range, the
/// crop (which pixels are rendered, not what they show), how a value was written.
std::string resolved_job_text(const Job& job, int32_t frame,
                              const std::vector<AssetRecord>& assets = {});

}  // namespace hyades::core
