#include "core/scene/exteriors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/elementary.h"
#include "core/scene/media_around.h"

namespace hyades::core {
namespace {

/// How many places around an object are looked at.
constexpr uint32_t kPlaces = 64;

/// Places just outside of the surface of placement `object` when the shutter opens.
std::vector<Vec3> places_outside(const World& world, uint32_t object) {
  constexpr float kJustOutside = 1.001F;
  const Shape& shape = world.placement(object).shape;
  std::vector<Vec3> places;
  if (shape.kind == Shape::Kind::mesh) {
    const auto count = static_cast<uint32_t>(shape.mesh->triangles.size());
    for (uint32_t i = 0; i < std::min(kPlaces, count); ++i) {
      const auto triangle = static_cast<uint32_t>(uint64_t{i} * count / std::min(kPlaces, count));
      const SurfacePoint point =
          world.triangle_point(object, triangle, 1.0F / 3.0F, 1.0F / 3.0F, 0.0F);
      const Vec3 normal = glm::cross(point.dpdu, point.dpdv);
      if (glm::dot(normal, normal) > 0.0F) places.push_back(offset_position(point, point.ng));
    }
    return places;
  }
  const Mat4 to_world = world.transform_at(object, 0.0F);
  for (uint32_t i = 0; i < kPlaces; ++i) {
    // A spiral from top to bottom.
    const float height = 1.0F - 2.0F * (static_cast<float>(i) + 0.5F) / kPlaces;
    const auto [s, c] = sin_cos(2.4F * static_cast<float>(i));
    const bool tube = shape.kind == Shape::Kind::cylinder;
    const float reach = tube ? 1.0F : std::sqrt(1.0F - height * height);
    const Vec3 at(
        shape.radius * kJustOutside * reach * c,
        tube ? 0.5F * shape.height * (1.0F + height) : shape.radius * kJustOutside * height,
        shape.radius * kJustOutside * reach * s);
    places.push_back(transform_point(to_world, at));
  }
  return places;
}

}  // namespace

Status check_exteriors(const Job& job, const std::vector<FlatObject>& objects, const Scene& scene) {
  for (uint32_t i = 0; i < objects.size(); ++i) {
    const std::string& exterior = objects[i].desc->exterior;
    if (exterior.empty() || objects[i].body != i) continue;
    for (const Vec3& place : places_outside(*scene.world, i)) {
      const Body* body = media_around(scene, place, 0.0F).body();
      const std::string& there = body != nullptr ? body->filled_with : job.atmosphere;
      if (there == exterior) continue;
      const std::string seen = !there.empty()                    ? "'" + there + "'"
                               : body != nullptr && body->medium ? "a material's subsurface"
                                                                 : "nothing";
      return at_object(objects[i], Error{"its exterior is '" + exterior + "', but there is " +
                                         seen + " next to it, expected the same"});
    }
  }
  return {};
}

}  // namespace hyades::core
