#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/geometry/world.h"

namespace hyades::core {

/// From which size on geometry is instanced or shared instead of copied and built again. Tests set
/// them to 0 to see small meshes instanced.
struct BuildThresholds {
  /// A mesh that is placed several times is copied while all copies together stay within this many
  /// triangles: direct geometry traces faster.
  size_t copied_triangles = size_t{1} << 16;

  /// Still geometry gets a scene of its own, which the next frame can share, beyond this size; and
  /// so does a mesh that is placed elsewhere in every frame. Less is built again in no time.
  size_t shared_triangles = size_t{1} << 14;
};

/// build_world with thresholds of one's own. The bits of the native class depend on them.
Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache, RenderClass which,
                                                 const BuildThresholds& thresholds);

}  // namespace hyades::core
