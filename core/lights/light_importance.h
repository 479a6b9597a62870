#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/ray.h"
#include "core/lights/light_tree.h"

namespace hyades::core {

/// How bright a tree's node may be where light is looked for: an estimate in proportion to which
/// lights are chosen, 0 only where none arrives (Estevez & Kulla 2018, section 4.3).
namespace importance {

/// How a node is seen from a point: angles by their cosines.
struct Seen {
  Vec3 towards{0.0F};      ///< unit, to the middle of its box
  float distance2 = 0.0F;  ///< to there, at least the radius of the ball around the box
  float cos_size = -1.0F;  ///< half the angle of that ball; -1 from within
  float sin_size = 0.0F;
  float shining = 0.0F;  ///< cosine of the least angle between the normals and the way here; 0
                         ///< where no light comes here
};

inline Seen see(const LightTreeNode& node, const Vec3& from) {
  Seen seen;
  const Vec3 way = node.center - from;
  const float distance2 = glm::dot(way, way);
  seen.distance2 = std::max(distance2, node.radius2);
  if (!(distance2 > node.radius2)) {
    seen.shining = 1.0F;
    return seen;
  }
  seen.towards = way / std::sqrt(distance2);
  const float sin2 = node.radius2 / distance2;
  seen.sin_size = std::sqrt(sin2);
  seen.cos_size = std::sqrt(1.0F - sin2);
  float cosine = -glm::dot(node.axis, seen.towards);
  if ((node.lights & LightTreeNode::kTwoSided) != 0) cosine = std::abs(cosine);
  cosine = std::clamp(cosine, -1.0F, 1.0F);
  const float sine = std::sqrt(1.0F - cosine * cosine);
  const float sin_normals = std::sqrt(std::max(1.0F - node.cos_normals * node.cos_normals, 0.0F));
  const float cos_rest = cosine_narrowed(cosine, sine, node.cos_normals, sin_normals);
  const float sin_rest = sine_narrowed(cosine, sine, node.cos_normals, sin_normals);
  const float least = cosine_narrowed(cos_rest, sin_rest, seen.cos_size, seen.sin_size);
  seen.shining = least >= node.cos_beyond ? std::max(least, 0.0F) : 0.0F;
  return seen;
}

/// The square of the distance that counts. Near a long or wide lamp its nearest part lights most:
/// then it is the distance to the box (but within a box of many lights nothing is nearer than its
/// thickness) times that to its middle.
inline float effective_distance2(const LightTreeNode& node, const Vec3& from, float distance2) {
  const Vec3 off = glm::max(glm::abs(from - node.center) - node.half_size, Vec3(0.0F));
  const float nearest2 = std::max(glm::dot(off, off), 0.25F * node.thickness2);
  return std::max(std::sqrt(nearest2 * distance2), 1e-30F);
}

/// For a place on a surface with unit normal `normal` (zero: none). Light may come from either
/// side, and bumps make light of what comes edge-on: it still counts a tenth.
inline float at_point(const LightTreeNode& node, const Vec3& from, const Vec3& normal) {
  const Seen seen = see(node, from);
  if (!(seen.shining > 0.0F)) return 0.0F;
  float received = 1.0F;
  if (glm::dot(normal, normal) > 0.0F && seen.cos_size >= 0.0F) {
    const float cosine = std::min(std::abs(glm::dot(normal, seen.towards)), 1.0F);
    const float sine = std::sqrt(1.0F - cosine * cosine);
    received = 0.1F + 0.9F * cosine_narrowed(cosine, sine, seen.cos_size, seen.sin_size);
  }
  return node.intensity * seen.shining * received / effective_distance2(node, from, seen.distance2);
}

/// For a way of `length` along `ray` on which light may be scattered anywhere: what arrives at the
/// nearest place, times how long it stays as near as that, in proportion to the distance.
inline float along_way(const LightTreeNode& node, const Ray& ray, float length) {
  const float t = glm::dot(node.center - ray.origin, ray.direction);
  const Vec3 from = ray.origin + ray.direction * std::clamp(t, 0.0F, length);
  const Seen seen = see(node, from);
  return node.intensity * seen.shining / std::sqrt(effective_distance2(node, from, seen.distance2));
}

}  // namespace importance
}  // namespace hyades::core
