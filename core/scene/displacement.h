#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/geometry/mesh.h"
#include "core/job/job.h"
#include "core/scene/appearance.h"

namespace hyades::core {

/// What displacing a mesh depends on besides its description.
struct DisplacementSetting {
  Appearance& looks;    ///< whose moment it is: the opening of the shutter
  Mat4 to_world{1.0F};  ///< of the object at that moment, to metres
  MeshExtras extras;    ///< what meshes need besides their shape
};

/// Whether `object` is displaced at any time.
bool may_be_displaced(const ObjectDesc& object);

/// Whether `object` is displaced at `time`; with a height of 0 it is the mesh itself.
bool is_displaced(const ObjectDesc& object, const JobTime& time);

/// Whether the displacement of `object` may change over frames; the same at every frame.
bool displacement_changes(const Job& job, const ObjectDesc& object);

/// The mesh of `object`, which is_displaced, in small triangles and moved by its texture. Shared
/// with all that ask for the same, and with the frame before (SceneCache::displaced).
Result<std::shared_ptr<const TriangleMesh>> displaced_mesh(const ObjectDesc& object,
                                                           const DisplacementSetting& setting);

}  // namespace hyades::core
