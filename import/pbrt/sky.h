#pragma once

#include <vector>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts `environment` into `out`: of lights without pictures a colour, else the file "sky.exr",
/// which is made of all of them.
void add_environment(Context& context, const std::vector<const LightEntity*>& lights, YamlMap& out);

/// The bytes of "sky.exr": a panorama of all infinite lights.
Result<Bytes> make_sky(const LoadedScene& scene);

}  // namespace hyades::core::pbrt
