#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/elementary.h"
#include "core/base/vec.h"

/// Maps from the unit square to shapes, each beside its density and its inverse. All are continuous
/// on the square (up to one seam) and keep areas in proportion, so that stratified points stay
/// stratified. Directions are in local coordinates, z up; densities of directions are per unit
/// solid angle, of points per unit area of the shape.
namespace hyades::core {

/// Unit disk (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
inline Vec2 square_to_disk(const Vec2& u) {
  const float a = 2.0F * u.x - 1.0F;
  const float b = 2.0F * u.y - 1.0F;
  if (a == 0.0F && b == 0.0F) return Vec2(0.0F);
  const bool wide = std::fabs(a) > std::fabs(b);
  const double r = wide ? a : b;
  const double angle = elementary::kQuarterPiD * (wide ? double{b} / a : double{a} / b);
  const auto along = static_cast<float>(r * elementary::cos_reduced(angle));
  const auto across = static_cast<float>(r * elementary::sin_reduced(angle));
  return wide ? Vec2(along, across) : Vec2(across, along);
}
inline float disk_pdf() { return kInvPi; }
inline Vec2 disk_to_square(const Vec2& p) {
  const float r = std::min(1.0F, std::sqrt(p.x * p.x + p.y * p.y));
  if (r == 0.0F) return Vec2(0.5F);
  const bool wide = std::fabs(p.x) > std::fabs(p.y);
  const float along = wide ? p.x : p.y;
  const float across = wide ? p.y : p.x;
  const float sign = along < 0.0F ? -1.0F : 1.0F;
  const float other = r * (atan2(sign * across, sign * along) * (4.0F * kInvPi));
  const Vec2 ab = wide ? Vec2(sign * r, sign * other) : Vec2(sign * other, sign * r);
  return 0.5F * ab + 0.5F;
}

/// Directions in proportion to z = cos(theta), z > 0 always (Malley's method).
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
  const Vec2 p = square_to_disk(u);
  const float a = std::max(std::fabs(2.0F * u.x - 1.0F), std::fabs(2.0F * u.y - 1.0F));
  return {p.x, p.y, std::sqrt(std::max(1.0F - a * a, 0x1p-24F))};
}
inline float cosine_hemisphere_pdf(float cosine) { return std::max(cosine, 0.0F) * kInvPi; }
inline Vec2 cosine_hemisphere_to_square(const Vec3& w) { return disk_to_square({w.x, w.y}); }

/// Directions within `angle` of +z, where one_minus_cos = 1 - cos(angle) in (0, 2]: said this way,
/// a cone of 1e-4 degrees keeps its precision.
inline Vec3 square_to_cone(const Vec2& u, float one_minus_cos) {
  const Vec2 p = square_to_disk(u);
  const float a = std::max(std::fabs(2.0F * u.x - 1.0F), std::fabs(2.0F * u.y - 1.0F));
  const float h = one_minus_cos * a * a;  // 1 - z is uniform
  const float stretch = std::sqrt(std::max(one_minus_cos * (2.0F - h), 0.0F));
  return {p.x * stretch, p.y * stretch, 1.0F - h};
}
inline float cone_pdf(float one_minus_cos) { return 0.5F * kInvPi / one_minus_cos; }
inline Vec2 cone_to_square(const Vec3& w, float one_minus_cos) {
  const float sine2 = w.x * w.x + w.y * w.y;
  const float h = w.z > 0.0F ? sine2 / (1.0F + w.z) : 1.0F - w.z;
  const float stretch2 = one_minus_cos * (2.0F - h);
  if (!(stretch2 > 0.0F)) return {0.5F, 1.0F};
  return disk_to_square(Vec2(w.x, w.y) / std::sqrt(stretch2));
}

/// All directions with z >= 0 alike.
inline Vec3 square_to_uniform_hemisphere(const Vec2& u) { return square_to_cone(u, 1.0F); }
inline float uniform_hemisphere_pdf() { return 0.5F * kInvPi; }
inline Vec2 uniform_hemisphere_to_square(const Vec3& w) { return cone_to_square(w, 1.0F); }

/// All directions alike: u.x is height, u.y longitude.
inline Vec3 square_to_uniform_sphere(const Vec2& u) {
  const float r = 2.0F * std::sqrt(u.x * (1.0F - u.x));
  const SinCos phi = sin_cos(2.0F * kPi * u.y);
  return {r * phi.cos, r * phi.sin, 1.0F - 2.0F * u.x};
}
inline float uniform_sphere_pdf() { return 0.25F * kInvPi; }
inline Vec2 uniform_sphere_to_square(const Vec3& w) {
  const float turn = atan2(w.y, w.x) * (0.5F * kInvPi);
  return {0.5F - 0.5F * w.z, turn < 0.0F ? std::min(turn + 1.0F, 0x1.fffffep-1F) : turn};
}

/// Barycentric weights (b0, b1) of the first two corners of a triangle, the third has
/// 1 - b0 - b1 (Heitz 2019, "A Low-Distortion Map Between Triangle and Square"). The density per
/// area is 1 / area.
inline Vec2 square_to_triangle(const Vec2& u) {
  if (u.y > u.x) return {0.5F * u.x, u.y - 0.5F * u.x};
  return {u.x - 0.5F * u.y, 0.5F * u.y};
}
inline Vec2 triangle_to_square(const Vec2& b) {
  if (b.y > b.x) return {2.0F * b.x, b.y + b.x};
  return {b.x + b.y, 2.0F * b.y};
}

/// Regular polygon of `sides` >= 3 corners on the unit circle, the first at angle `rotation`
/// (radians): one triangle of the fan around the centre per side, chosen by u.x.
inline Vec2 square_to_polygon(const Vec2& u, int sides, float rotation) {
  const float scaled = u.x * static_cast<float>(sides);
  const int side = std::min(static_cast<int>(scaled), sides - 1);
  const Vec2 b = square_to_triangle({std::min(scaled - static_cast<float>(side), 1.0F), u.y});
  const float step = 2.0F * kPi / static_cast<float>(sides);
  const SinCos p = sin_cos(rotation + step * static_cast<float>(side));
  const SinCos q = sin_cos(rotation + step * static_cast<float>(side + 1));
  return b.x * Vec2(p.cos, p.sin) + b.y * Vec2(q.cos, q.sin);
}
/// 1 / area of that polygon.
inline float polygon_pdf(int sides) {
  const auto n = static_cast<float>(sides);
  return 2.0F / (n * sin(2.0F * kPi / n));
}
inline Vec2 polygon_to_square(const Vec2& point, int sides, float rotation) {
  const auto n = static_cast<float>(sides);
  const float step = 2.0F * kPi / n;
  float turn = (atan2(point.y, point.x) - rotation) / (2.0F * kPi);
  turn -= std::floor(turn);
  const int side = std::min(static_cast<int>(turn * n), sides - 1);
  const SinCos p = sin_cos(rotation + step * static_cast<float>(side));
  const SinCos q = sin_cos(rotation + step * static_cast<float>(side + 1));
  const float det = p.cos * q.sin - p.sin * q.cos;
  const Vec2 b((point.x * q.sin - point.y * q.cos) / det,
               (p.cos * point.y - p.sin * point.x) / det);
  const Vec2 u = triangle_to_square({std::max(b.x, 0.0F), std::max(b.y, 0.0F)});
  return {(static_cast<float>(side) + std::min(u.x, 1.0F)) / n, std::min(u.y, 1.0F)};
}

}  // namespace hyades::core
