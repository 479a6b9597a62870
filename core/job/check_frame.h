#pragma once

#include <cstdint>
#include <optional>

#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::core {

/// Whether the job's animated values keep to their ranges at `frame` (and, where they count while
/// the shutter is open, at all its moments). The first one that does not is the error:
/// "job.yaml:3:15: fov is 200 at frame 12, expected a number above 0 and below 180". Reading a job
/// tries some frames; building a scene tries its own.
Status check_frame(const Job& job, int32_t frame);

/// What one check has to say about a frame, if anything.
std::optional<Diagnostic> complaint_at(const Job& job, int32_t frame, const NumberCheck& check);
std::optional<Diagnostic> complaint_at(const Job& job, int32_t frame, const VectorCheck& check);

/// Whether one frame speaks for all.
bool is_constant(const NumberCheck& check);
bool is_constant(const VectorCheck& check);

}  // namespace hyades::core
