#pragma once

#include "core/film/noise.h"
#include "core/job/job.h"

namespace hyades::core {

/// The first of the job's outputs that is for a display, not EXR; null where there is none.
const OutputDesc* display_output(const Job& job);

/// With how many stops the job's pictures are looked at: those of its first output for a display;
/// where there is none of the first output, which is the camera's.
float shown_exposure(const Job& job);

/// When the job's tiles are judged, and when they have samples enough. Without a noise to stop at,
/// or with too few samples for a round, the aim has no noise.
NoiseThreshold noise_threshold(const Job& job);

}  // namespace hyades::core
