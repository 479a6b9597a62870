#include "core/integrators/path_vertex.h"

#include <cmath>
#include <cstddef>

#include "core/integrators/visibility.h"

namespace hyades::core {

Rgb PathVertex::evaluate(const Vec3& out, const Vec3& in, TransportMode mode) const {
  if (kind == Kind::surface) return surface->evaluate(out, in, mode);
  return medium->phase().evaluate(glm::dot(-out, in));
}

double PathVertex::pdf(const Vec3& out, const Vec3& in, TransportMode mode) const {
  if (kind == Kind::surface) return static_cast<double>(surface->pdf(out, in, mode));
  return static_cast<double>(medium->phase().pdf(glm::dot(-out, in), Rgb(1.0F / 3.0F)));
}

double PathVertex::per_direction(const Vec3& from, const Vec3& towards) const {
  if (infinitely_far) return 1.0;
  const Vec3d way = Vec3d(position) - Vec3d(from);
  const double distance2 = glm::dot(way, way);
  if (!(distance2 > 0.0)) return 0.0;
  const bool on_surface = kind == Kind::surface || (kind == Kind::light && point.ng != Vec3(0.0F));
  return (on_surface ? static_cast<double>(std::abs(glm::dot(point.ng, towards))) : 1.0) /
         distance2;
}

double PathVertex::across(const Vec3& towards) const {
  return kind == Kind::surface ? static_cast<double>(std::abs(glm::dot(point.ng, towards))) : 1.0;
}

MediumStack PathVertex::around_towards(const Vec3& direction) const {
  MediumStack bodies = around;
  if (kind == Kind::surface && glm::dot(wo, point.ng) * glm::dot(direction, point.ng) < 0.0F) {
    cross(*object, point, direction, bodies);
  }
  return bodies;
}

PathVertex& Subpath::add(PathVertex::Kind kind) {
  if (static_cast<size_t>(size_) == vertices_.size()) vertices_.emplace_back();
  PathVertex& v = vertices_[static_cast<size_t>(size_++)];
  v.kind = kind;
  v.surface.reset();
  v.object = nullptr;
  v.medium = nullptr;
  v.infinitely_far = false;
  v.density = 1.0;
  v.edge = v.beyond = v.chain = 0.0;
  return v;
}

Ray ray_between(const PathVertex& a, const PathVertex& b, float time) {
  const bool from_surface = a.kind == PathVertex::Kind::surface;
  const bool to_surface = b.kind == PathVertex::Kind::surface;
  if (from_surface && to_surface) return spawn_ray_to(a.point, b.point);
  if (from_surface) return spawn_ray_to(a.point, b.position, 0.0F);
  const Vec3 end = to_surface ? offset_position(b.point, a.position - b.position) : b.position;
  return ray_between(a.position, end, time);
}

}  // namespace hyades::core
