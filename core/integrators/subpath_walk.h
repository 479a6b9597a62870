#pragma once

#include "core/integrators/path_vertex.h"
#include "core/integrators/random_walk.h"

namespace hyades::core {

/// The density in the measure of `v` with which `segment`, from a vertex at `from`, leads to it.
double density_at(const PathSegment& segment, const PathVertex& v, const Vec3& from);

/// What a walk meets that keeps its vertices.
class SubpathWatcher : public WalkWatcher {
 public:
  /// A vertex was added; the walk has not gone on from it. False: the path ends before it.
  virtual bool arrives(const PathVertex& /*vertex*/) { return true; }

  /// The walk goes on from its last vertex along `segment`.
  virtual void goes_on(const PathVertex& /*from*/, const PathSegment& /*segment*/) {}
};

/// Lengthens `path`, which has the first vertex, from which `walk` starts, by what the walk meets:
/// vertices, and what their weights need. Until there are `most` of them, the walk leaves the
/// scene, or roulette ends it. `watcher` is the walk's.
void lengthen(Subpath& path, RandomWalk& walk, int most, SubpathWatcher& watcher);

}  // namespace hyades::core
