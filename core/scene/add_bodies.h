#pragma once

#include <vector>

#include "core/scene/appearance.h"
#include "core/scene/flatten.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// Gives the objects of `scene`, which have their materials, their bodies: where there are media,
/// or where one body may stand within another that refracts. `objects` and `placements` are in the
/// order of `scene.objects`; `placements`, not in a world yet, learn which surfaces do not block
/// light for certain. Errors: an interior that cannot be made, or not be shown by the integrator.
Status add_bodies(const Job& job, const std::vector<FlatObject>& objects, Appearance& looks,
                  Scene& scene, std::vector<Placement>& placements);

/// Warns in `scene` of meshes that have no inside though light goes into them: open ones, and those
/// whose normals point inwards. Each mesh is told once.
void warn_of_open_bodies(const std::vector<FlatObject>& objects, SceneCache& cache, Scene& scene);

}  // namespace hyades::core
