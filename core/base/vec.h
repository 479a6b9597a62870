#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

/// The vector types of the whole core. GLM's + - * / sqrt are correctly rounded and so safe for
/// equal bits; its transcendental wrappers (glm::sin, glm::pow, ...) are not: see elementary.h.
namespace hyades::core {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Vec2i = glm::ivec2;
using Vec3i = glm::ivec3;
using Vec3d = glm::dvec3;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;  ///< column-major; a point transforms as M * (p, 1)

/// Linear Rec.709 red, green and blue: radiance, reflectance or a coefficient per channel.
using Rgb = glm::vec3;

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kInvPi = 0.318309886183790671538F;
inline constexpr float kRadians = kPi / 180.0F;  ///< in a degree

/// M applied to a point (translation included, no perspective division).
inline Vec3 transform_point(const Mat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1.0F)); }

/// M applied to a direction or difference of points (no translation).
inline Vec3 transform_vector(const Mat4& m, const Vec3& v) { return Vec3(m * Vec4(v, 0.0F)); }

inline float max_component(const Vec3& v) {
  return v.x > v.y ? (v.x > v.z ? v.x : v.z) : (v.y > v.z ? v.y : v.z);
}

inline float min_component(const Vec3& v) {
  return v.x < v.y ? (v.x < v.z ? v.x : v.z) : (v.y < v.z ? v.y : v.z);
}

/// Relative luminance Y of linear Rec.709 (ITU-R BT.709-6, item 3.2).
inline float luminance(const Rgb& c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

inline bool is_black(const Rgb& c) { return c.x == 0.0F && c.y == 0.0F && c.z == 0.0F; }

}  // namespace hyades::core
