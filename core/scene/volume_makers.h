#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/job/density_desc.h"
#include "core/job/time.h"
#include "core/media/volume.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// A volume, and the way from its field's space into that of the body which it fills.
struct PlacedVolume {
  std::shared_ptr<const Volume> volume;
  Mat4 to_body{1.0F};
};

/// What `desc` describes at `time` in a body of bounds `body`.
Result<PlacedVolume> make_volume(const DensityDesc& desc, const JobTime& time, const Bounds& body,
                                 SceneCache& cache);

}  // namespace hyades::core
