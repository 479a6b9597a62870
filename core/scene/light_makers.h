#pragma once

#include <optional>

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

/// The light that `desc` describes (no shape's emission, no environment), without the size that a
/// lamp has; its picture is of `cache`.
Result<LightPtr> make_light(const LightDesc& desc, const LightSetting& setting, SceneCache& cache);

/// A light that shines from a ball and not from a single place.
struct Lamp {
  PointSourcePtr source;
  float radius = 0.0F;                  ///< above 0 [m]
  bool changes_between_frames = false;  ///< as in Placement
};

/// The lamp that `desc` describes; nothing where its light has no size.
Result<std::optional<Lamp>> make_lamp(const LightDesc& desc, const LightSetting& setting,
                                      SceneCache& cache);

}  // namespace hyades::core
