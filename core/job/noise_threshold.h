#pragma once

#include "core/film/noise.h"
#include "core/job/job.h"

namespace hyades::core {

/// At what noise the job's tiles have samples enough, and when they are judged; the noise is that
/// of the job's first output for displays, with its exposure.
NoiseThreshold noise_threshold(const Job& job);

}  // namespace hyades::core
