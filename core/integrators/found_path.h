#pragma once

#include <cstdint>

#include "core/integrators/path_vertex.h"

namespace hyades::core {

/// A path that a strategy of bidirectional path tracing has found, while it is looked at: the first
/// `s` vertices of the light path joined to the first `t` of the camera path. Their own beginnings
/// are no part of it where s = 1 (the light) or t = 1 (the camera), but `end` is; where s = 0 it is
/// the last of the camera path.
struct FoundPath {
  const Subpath& light;
  const Subpath& camera;
  int s = 0;
  int t = 0;
  uint32_t light_index = 0;  ///< which light, of all paths
  Vec3 direction{0.0F};      ///< unit, towards `end` from the vertex before
  Vec3 end{0.0F};            ///< on a finite light (s < 2) or on the lens (t = 1)
  bool specular = false;     ///< s = 0: a delta lobe led to `end`
  double weight = 1.0;
};

/// Somebody who wants to know which paths are found, and what they weigh.
class PathWatcher {
 public:
  virtual ~PathWatcher() = default;
  virtual void found(const FoundPath& path) = 0;
};

}  // namespace hyades::core
