#include "core/scene/film_motion.h"

#include <cmath>
#include <vector>

#include "core/scene/scene.h"

namespace hyades::core {
namespace {

constexpr float kFarAway = 1e9F;  ///< m, where directions are looked at

Vec3 place(const Mat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1.0F)); }

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

Vec2 FilmMotion::of(const Scene& scene, uint32_t object, const Vec3& position, const Ray& ray,
                    float time) const {
  const bool met = object < to_world.size();
  // What is infinitely far is the same from everywhere.
  if (!met && camera->rays_are_parallel()) return Vec2(0.0F);
  Vec3 now = ray.origin + ray.direction * kFarAway;
  Vec3 then = now;
  if (met) {
    const Vec3 in_object = place(glm::inverse(scene.world->transform_at(object, time)), position);
    now = place(scene.world->transform_at(object, 0.0F), in_object);
    then = place(to_world[object], in_object);
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
