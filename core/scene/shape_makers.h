#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/world.h"
#include "core/job/job.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// The shape of an object (no group, no instance) in its own space, in the job's unit of length.
Result<Shape> make_shape(const ObjectDesc& object, SceneCache& cache);

/// The normals that a mesh's `normals` names.
Result<MeshNormals> mesh_normals_of(const ObjectDesc& object);

/// The names that can be made: those of core/job/kinds.h.
std::vector<std::string> made_shapes();
std::vector<std::string> made_mesh_normals();

}  // namespace hyades::core
