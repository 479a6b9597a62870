#include "core/scene/film_motion.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/scene/scene.h"

namespace hyades::core {
namespace {

constexpr float kFarAway = 1e9F;  ///< m, where directions are looked at

Vec3 place(const Mat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1.0F)); }

/// Barycentrics of a point on (or near) a triangle: those of its first corner where that is
/// degenerate.
Vec3d weights_of(const Vec3d& p, const std::array<Vec3d, 3>& corners) {
  const Vec3d e1 = corners[1] - corners[0];
  const Vec3d e2 = corners[2] - corners[0];
  const Vec3d d = p - corners[0];
  const double a = glm::dot(e1, e1);
  const double b = glm::dot(e1, e2);
  const double c = glm::dot(e2, e2);
  const double determinant = a * c - b * b;
  if (!(determinant > 0.0)) return {1.0, 0.0, 0.0};
  const double u = (c * glm::dot(d, e1) - b * glm::dot(d, e2)) / determinant;
  const double v = (a * glm::dot(d, e2) - b * glm::dot(d, e1)) / determinant;
  return {1.0 - u - v, u, v};
}

Vec3 weighted(const std::array<Vec3d, 3>& corners, const Vec3d& weights) {
  return Vec3(corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z);
}

/// Of the places that are the same as `film` the one that is nearest to `to`, at most about a film
/// away.
Vec2 nearest_place(const Camera& camera, const Vec2& film, const Vec2& to, const Vec2& size) {
  std::vector<Vec2> places;
  camera.add_places(film, to - size, to + size, places);
  Vec2 nearest = film;
  for (const Vec2& place : places) {
    const Vec2 way = place - to;
    const Vec2 least = nearest - to;
    if (glm::dot(way, way) < glm::dot(least, least)) nearest = place;
  }
  return nearest;
}

}  // namespace

Vec2 FilmMotion::of(const Scene& scene, uint32_t object, uint32_t primitive, const Vec3& position,
                    const Ray& ray, float time) const {
  const bool met = object < to_world.size();
  // What is infinitely far is the same from everywhere.
  if (!met && camera->rays_are_parallel()) return Vec2(0.0F);
  Vec3 now = ray.origin + ray.direction * kFarAway;
  Vec3 then = now;
  if (met) {
    const Vec3 in_object = place(glm::inverse(scene.world->transform_at(object, time)), position);
    now = place(scene.world->transform_at(object, 0.0F), in_object);
    then = place(to_world[object], in_object);
    if (meshes[object] != nullptr) {
      const Shape& shape = scene.world->placement(object).shape;
      const Vec3d weights = weights_of(Vec3d(in_object), shape.corners_at(primitive, time));
      Shape next;
      next.mesh = meshes[object];
      now = place(scene.world->transform_at(object, 0.0F),
                  weighted(shape.corners_at(primitive, 0.0F), weights));
      then = place(to_world[object], weighted(next.corners_at(primitive, 0.0F), weights));
    }
  }
  const Vec2 middle(0.5F);
  const auto from = camera->connect(now, middle, 0.0F);
  const auto to = next_camera->connect(then, middle, 0.0F);
  if (!from || !to) return Vec2(0.0F);
  const Vec2 moved =
      nearest_place(*next_camera, to->film, from->film, scene.resolution) - from->film;
  // Shapes that are flat in some frame come from nowhere.
  if (!std::isfinite(moved.x) || !std::isfinite(moved.y)) return Vec2(0.0F);
  return {moved.x, -moved.y};
}

}  // namespace hyades::core
