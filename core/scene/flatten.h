#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/world.h"
#include "core/job/job.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// An object of the job after groups and instances have been flattened: one shape, its place, its
/// looks.
struct FlatObject {
  const ObjectDesc* desc = nullptr;  ///< in the job
  std::string name;                  ///< "tree1/trunk"
  std::string material;  ///< name; inherited from the enclosing group where the object has none
  size_t body = 0;       ///< index of the first of all parts of its closed surface
  std::optional<EmitDesc> emit;
  bool holdout = false;
  std::string notice;   ///< what of its shape is probably not meant
  Placement placement;  ///< in metres
};

/// The rays that see it.
RayKind kinds_of(const VisibilityDesc& visible);

/// `error` with the name of `object`, and where in the job it stands.
Error at_object(const FlatObject& object, const Error& error);

/// Most objects that groups and instances may make; more is refused with a clear error.
inline constexpr size_t kMaxPlacements = 50'000'000;

/// What becomes of meshes with a displacement.
enum class Displacements {
  made,
  left_out,  ///< the meshes stay as they are: for those who ask for places only
};

/// All objects of a job at `frame`, in document order (Debian 12's Embree has one level of
/// instancing, so nesting is multiplied out here).
Result<std::vector<FlatObject>> flatten_objects(const Job& job, int32_t frame, SceneCache& cache,
                                                Displacements displacements = Displacements::made);

}  // namespace hyades::core
