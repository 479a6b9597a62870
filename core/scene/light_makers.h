#pragma once

#include "core/base/result.h"
#include "core/job/job.h"
#include "core/lights/make_light.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// What a light is made for.
struct LightSetting {
  JobTime time;
  float units = 1.0F;         ///< metres per unit of length of the job
  float world_radius = 1.0F;  ///< metres; infinite lights weigh their power by it
  SkyDensity sky_density = SkyDensity::luminance;  ///< of the environment
};

/// The light that `desc` describes (no shape's emission, no environment); its picture is of
/// `cache`.
Result<LightPtr> make_light(const LightDesc& desc, const LightSetting& setting, SceneCache& cache);

}  // namespace hyades::core
