#include "core/geometry/placed_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/geometry/placement_check.h"

namespace hyades::core {
namespace {

/// Directions are unit vectors; longer ones are refused long before they overflow.
constexpr float kLongestDirection = 1e3F;

/// How often a hit that exact arithmetic denies is skipped before the ray counts as a miss.
constexpr int kMaxRetries = 16;

/// False for NaN too.
bool within(const Vec3& v, float limit) {
  return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
}

}  // namespace

PlacedWorld::PlacedWorld(WorldParts parts)
    : parts_(std::move(parts)), still_number_(static_cast<uint32_t>(parts_.objects.size())) {
  std::set<const MeshBuffers*> copies;
  for (uint32_t i = 0; i < parts_.objects.size(); ++i) {
    if (instancer_of(i) != nullptr) continue;
    const auto& object = parts_.objects[i];
    bounds_.include(object->bounds());
    const MeshBuffers* buffers = object->buffers();
    if (buffers != nullptr && copies.insert(buffers).second) memory_ += buffers->own_memory();
  }
  for (const PlacedInstancer& instancer : parts_.instancers) {
    bounds_.include(instancer.scene->bounds());
    memory_ += instancer.scene->memory();
  }
  memory_ += parts_.top->memory();
  if (parts_.still != nullptr) memory_ += parts_.still->scene->memory();
  for (const auto& mesh : parts_.mesh_scenes) memory_ += mesh->scene->memory();
}

bool PlacedWorld::usable(const Ray& ray) const {
  const Vec3& d = ray.direction;
  const bool good = within(ray.origin, kRayReach) && within(d, kLongestDirection) &&
                    glm::dot(d, d) > 0.0F && std::isfinite(ray.time) && !std::isnan(ray.t_max);
  if (!good) invalid_rays_.fetch_add(1, std::memory_order_relaxed);
  return good && ray.t_max > kNearest;
}

template <class Take>
bool PlacedWorld::find_nearest(const Ray& ray, RayKind kind, Take&& take) const {
  if (!usable(ray)) return false;
  float t_min = kNearest;
  for (int i = 0; i < kMaxRetries; ++i) {
    const auto hit = parts_.top->nearest(ray, kind, t_min);
    if (!hit) return false;
    if (hit->number > still_number_) {
      const PlacedInstancer& instancer = parts_.instancers[hit->number - still_number_ - 1];
      if (take(instancer.first + hit->copied, hit->primitive, instancer.scene.get(), hit->copy))
        return true;
    } else if (take(object_of(*hit), hit->primitive, nullptr, 0U)) {
      return true;
    }
    // The primitive lies behind the origin, beyond the end or edge-on, by less than float can tell.
    t_min = std::nextafter(static_cast<float>(hit->t), kInfinity);
    if (!(t_min < ray.t_max)) return false;
  }
  return false;
}

std::optional<Hit> PlacedWorld::intersect(const Ray& ray, RayKind kind) const {
  std::optional<Hit> hit;
  find_nearest(
      ray, kind,
      [&](uint32_t object, uint32_t primitive, const InstancerScene* instancer, uint32_t copy) {
        if (instancer == nullptr) {
          hit = parts_.objects[object]->meet(ray, primitive);
        } else {
          const CopyPose pose = instancer->pose(copy, ray.time);
          hit = parts_.objects[object]->meet(ray, primitive, &pose);
        }
        if (hit) hit->object = object;
        if (hit) hit->copy = copy;
        return hit.has_value();
      });
  return hit;
}

bool PlacedWorld::nearest(const Ray& ray, RayKind kind, SurfacePoint& point) const {
  return find_nearest(
      ray, kind,
      [&](uint32_t object, uint32_t primitive, const InstancerScene* instancer, uint32_t copy) {
        if (instancer == nullptr) {
          if (!parts_.objects[object]->meet(ray, primitive, point)) return false;
        } else {
          const CopyPose pose = instancer->pose(copy, ray.time);
          if (!parts_.objects[object]->meet(ray, primitive, point, &pose)) return false;
        }
        point.object = object;
        return true;
      });
}

bool PlacedWorld::occluded(const Ray& ray) const {
  return usable(ray) && parts_.top->occluded(ray);
}

SurfacePoint PlacedWorld::surface(const Ray& ray, const Hit& hit) const {
  std::optional<CopyPose> pose;
  if (const InstancerScene* instancer = instancer_of(hit.object))
    pose = instancer->pose(hit.copy, ray.time);
  SurfacePoint p = parts_.objects[hit.object]->point(ray, hit, pose ? &*pose : nullptr);
  p.object = hit.object;
  return p;
}

SurfacePoint PlacedWorld::triangle_point(uint32_t object, uint32_t primitive, float u, float v,
                                         float time) const {
  std::optional<CopyPose> pose;
  if (const InstancerScene* instancer = instancer_of(object)) pose = instancer->pose(0, time);
  SurfacePoint p =
      parts_.objects[object]->mesh_point(primitive, u, v, time, pose ? &*pose : nullptr);
  p.object = object;
  return p;
}

SurfacePoint PlacedWorld::quadric_point(uint32_t object, const Vec3& near, float time) const {
  SurfacePoint p = parts_.objects[object]->quadric_place(Vec3d(near), time);
  p.object = object;
  return p;
}

Mat4 PlacedWorld::transform_at(uint32_t object, float time) const {
  if (const InstancerScene* instancer = instancer_of(object))
    return instancer->motion().at(time).to_mat4();
  const PlacedObject& placed = *parts_.objects[object];
  return placed.motion().still() ? placed.placement().to_world[0]
                                 : placed.motion().at(time).to_mat4();
}

const Placement& PlacedWorld::placement(uint32_t object) const {
  return parts_.objects[object]->placement();
}

const InstancerScene* PlacedWorld::instancer_of(uint32_t object) const {
  for (const PlacedInstancer& instancer : parts_.instancers) {
    if (object >= instancer.first &&
        object - instancer.first < instancer.scene->inner().placement_count()) {
      return instancer.scene.get();
    }
  }
  return nullptr;
}

Bounds PlacedWorld::bounds_of(uint32_t object) const {
  const InstancerScene* instancer = instancer_of(object);
  const Bounds own = parts_.objects[object]->bounds();
  return instancer == nullptr ? own : instancer->bounds_of(own);
}

uint32_t PlacedWorld::placement_count() const {
  return static_cast<uint32_t>(parts_.objects.size());
}

}  // namespace hyades::core
