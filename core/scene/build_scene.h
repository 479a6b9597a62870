#pragma once

#include <cstdint>
#include <memory>

#include "core/base/result.h"
#include "core/job/job.h"
#include "core/scene/scene.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// The scene of `frame`: a validated job at that moment, its lengths turned into metres, files
/// loaded through `cache`. Errors name the object, texture or file, what is wrong with it, and
/// where it stands in the job; files that cannot be loaded are all named, a line each. Animated
/// values that leave their range at this frame are refused first (check_frame).
Result<std::shared_ptr<const Scene>> build_scene(const Job& job, int32_t frame, SceneCache& cache);

}  // namespace hyades::core
