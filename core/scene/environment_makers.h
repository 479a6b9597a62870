#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/light_makers.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// A light that the job names only as part of its environment.
struct NamedLight {
  std::string name;
  LightPtr light;
};

/// What `integrator` chooses directions towards an environment in proportion to. `path` finds skies
/// by its BSDFs and phase functions too; the light paths of the others begin at them as well.
SkyDensity sky_density(const IntegratorDesc& integrator);

/// What shines from infinitely far away on all sides: an even colour, an image, or a clear sky and
/// its sun.
Result<std::vector<NamedLight>> make_environment(const EnvironmentDesc& desc,
                                                 const LightSetting& setting, SceneCache& cache);

}  // namespace hyades::core
