#include "core/integrators/subpath_walk.h"

#include <algorithm>
#include <cmath>

namespace hyades::core {
namespace {

TransportMode other(TransportMode mode) {
  return mode == TransportMode::radiance ? TransportMode::importance : TransportMode::radiance;
}

/// Solid angle on the side of wi over that on the side of wo, which refraction presses together or
/// apart: n^2 cos dw is the same on both sides.
double solid_angle_ratio(const ShadedSurface& surface, const Vec3& wo, const BsdfSample& sample) {
  if (!sample.transmitted) return 1.0;
  const auto cosine = [&](const Vec3& w) {
    return std::max(static_cast<double>(std::abs(glm::dot(w, surface.frame().n))), 1e-6);
  };
  const double eta = static_cast<double>(sample.eta);
  return cosine(wo) / (eta * eta * cosine(sample.wi));
}

/// The next place where light scatters, with what it has from the segment that led there; null
/// where there is none.
PathVertex* add_vertex(Subpath& path, RandomWalk& walk, ScatteringPlace& place) {
  if (!walk.next(place)) return nullptr;
  const bool on_surface = place.object != nullptr;
  const bool on_strand = on_surface && place.point.curves != nullptr;
  // A strand sends light on from its whole width, wherever it was met: where a path from the light
  // meets it is not where the camera sees it. So only paths from the camera scatter at strands.
  if (on_strand && walk.mode() == TransportMode::importance) return nullptr;
  PathVertex& v = path.add(on_surface ? PathVertex::Kind::surface : PathVertex::Kind::medium);
  v.position = place.position;
  if (on_surface) {
    v.point = place.point;
    v.object = place.object;
    v.surface.emplace(v.point, *v.object->material, path.arena());
  } else {
    v.medium = place.flight.medium;
  }
  const PathSegment& segment = walk.segment();
  const PathVertex& before = path[path.size() - 2];
  v.wo = -segment.ray.direction;
  v.throughput = segment.throughput;
  v.around = segment.around;
  v.density = density_at(segment, v, before.position);
  if (on_strand) return &v;  // no strategy has it, or what is before it, on the light's side
  v.edge = segment.specular ? 0.0 : 1.0;
  v.beyond = before.chain / (before.density * before.density);
  return &v;
}

/// Chooses the segment on from the last vertex; false where the walk ends.
bool scatter(Subpath& path, RandomWalk& walk) {
  const TransportMode mode = walk.mode();
  PathVertex& v = path.back();
  double backward = 0.0;  // density per solid angle of the direction to the vertex before
  if (v.kind == PathVertex::Kind::surface) {
    const auto sample = walk.scatter(*v.surface, *v.object, v.wo);
    if (!sample) return false;
    backward = sample->delta ? solid_angle_ratio(*v.surface, v.wo, *sample)
                             : v.pdf(sample->wi, v.wo, other(mode));
  } else {
    if (!walk.scatter(*v.medium, v.position)) return false;
    PathSegment& segment = walk.segment();
    segment.pdf = v.pdf(v.wo, segment.ray.direction, mode);
    backward = v.pdf(segment.ray.direction, v.wo, other(mode));
  }
  const double reverse = backward * path[path.size() - 2].per_direction(v.position, v.wo);
  v.chain = (walk.segment().specular ? 0.0 : v.edge) + v.beyond * reverse * reverse;
  return true;
}

}  // namespace

double density_at(const PathSegment& segment, const PathVertex& v, const Vec3& from) {
  const Vec3& direction = segment.ray.direction;
  if (segment.pdf_across > 0.0) return segment.pdf_across * v.across(direction);
  return segment.pdf * v.per_direction(from, direction);
}

void lengthen(Subpath& path, RandomWalk& walk, int most, SubpathWatcher& watcher) {
  ScatteringPlace place;
  while (path.size() < most) {
    const PathVertex* const vertex = add_vertex(path, walk, place);
    if (vertex == nullptr) return;
    if (!watcher.arrives(*vertex)) return path.drop_last();
    if (path.size() >= most || !scatter(path, walk)) return;
    watcher.goes_on(*vertex, walk.segment());
  }
}

}  // namespace hyades::core
