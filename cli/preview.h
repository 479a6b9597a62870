#pragma once

#include <cstdint>

#include "core/job/job.h"

namespace hyades::cli {

inline constexpr uint32_t kPreviewSamples = 32;

/// Makes small pictures of `job`: `width` pixels wide, of the whole frame, with few samples,
/// denoised; one PNG, NAME.preview.png (NAME.####.preview.png where there are several frames),
/// shown as the job's first output that is no EXR.
void make_preview(core::Job& job, int width);

}  // namespace hyades::cli
