#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/job.h"
#include "core/media/volume.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// A volume, and the way from its field's space into that of the body which it fills.
struct PlacedVolume {
  std::shared_ptr<const Volume> volume;
  Mat4 to_body{1.0F};
};

/// How the medium `desc`, which varies, does so at `time` in a body of bounds `body`.
Result<PlacedVolume> make_volume(const MediumDesc& desc, const JobTime& time, const Bounds& body,
                                 SceneCache& cache);

/// The names that can be made: those of core/job/medium_desc.h and density_desc.h.
std::vector<std::string> made_vdb_places();

}  // namespace hyades::core
