#include "core/lights/rectangle_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/elementary.h"

namespace hyades::core {

namespace {

/// Rectangles whose area is less than this part of the squared distance to their nearest point are
/// chosen from by area: seen from there they are nearly even, and the angles below cost more than
/// the rest of the light's sampling.
constexpr double kLeastExtent = 0.25;

/// So are those that cover less than this [sr] because they are seen from the side: the sum of
/// angles would lose figures.
constexpr double kLeastSolidAngle = 0.02;

double length(const Vec3d& v) { return std::sqrt(glm::dot(v, v)); }

/// The inner angle between two sides of a spherical polygon with normals a and b: pi minus the
/// angle between the normals, in the form that keeps its figures near 0 and pi.
double inner_angle(const Vec3d& a, const Vec3d& b) {
  return static_cast<double>(
      atan2(static_cast<float>(length(glm::cross(a, b))), static_cast<float>(-glm::dot(a, b))));
}

}  // namespace

/// A rectangle as seen from a point, in the paper's notation: local coordinates along the edges,
/// z pointing away from the rectangle.
struct SphericalRectangle {
  double x0, x1, y0, y1, z0;
  double b0, b1, k;
  double solid_angle;

  SphericalRectangle(double x_low, double x_high, double y_low, double y_high, double z)
      : x0(x_low), x1(x_high), y0(y_low), y1(y_high), z0(z > 0.0 ? -z : z) {
    // Normals of the sides' planes; each has a coordinate 0.
    const auto unit_x = [&](double y) { return Vec3d(0.0, z0, -y) / std::sqrt(z0 * z0 + y * y); };
    const auto unit_y = [&](double x) { return Vec3d(-z0, 0.0, x) / std::sqrt(z0 * z0 + x * x); };
    const Vec3d n0 = unit_x(y0);
    const Vec3d n1 = unit_y(x1);
    const Vec3d n2 = -unit_x(y1);
    const Vec3d n3 = -unit_y(x0);
    b0 = n0.z;
    b1 = n2.z;
    k = 2.0 * elementary::kPiD - inner_angle(n2, n3) - inner_angle(n3, n0);
    solid_angle = inner_angle(n0, n1) + inner_angle(n1, n2) - k;
  }

  /// The place (x, y) for u: equation numbers are the paper's.
  glm::dvec2 place(const Vec2& u) const {
    const SinCos phi = sin_cos(static_cast<float>(static_cast<double>(u.x) * solid_angle + k));
    const double sine = static_cast<double>(phi.sin);
    const double f = (static_cast<double>(phi.cos) * b0 - b1) / sine;
    const double c = std::clamp(std::copysign(1.0 / std::sqrt(f * f + b0 * b0), f), -1.0, 1.0);
    const double rest = std::sqrt(std::max(1.0 - c * c, 1e-24));
    const double x = std::clamp(-(c * z0) / rest, x0, x1);
    const double d2 = x * x + z0 * z0;
    const double h0 = y0 / std::sqrt(d2 + y0 * y0);
    const double h1 = y1 / std::sqrt(d2 + y1 * y1);
    const double h = h0 + static_cast<double>(u.y) * (h1 - h0);
    const double y = h * std::sqrt(d2 / std::max(1.0 - h * h, 1e-24));
    return {x, std::clamp(y, y0, y1)};
  }
};

std::optional<Rectangle> find_rectangle(const World& world, uint32_t object) {
  const Placement& placement = world.placement(object);
  if (placement.shape.kind != Shape::Kind::mesh || placement.to_world.size() != 1 ||
      placement.shape.deforms()) {
    return std::nullopt;
  }
  const TriangleMesh& mesh = *placement.shape.mesh;
  if (mesh.triangles.size() != 2) return std::nullopt;
  const auto& one = mesh.triangles[0];
  const auto& two = mesh.triangles[1];
  // The corner of each triangle that the other has not; the diagonal joins the shared ones.
  const auto lone = [](const std::array<uint32_t, 3>& of, const std::array<uint32_t, 3>& other) {
    int found = -1;
    for (int i = 0; i < 3; ++i) {
      if (std::find(other.begin(), other.end(), of[static_cast<size_t>(i)]) != other.end()) {
        continue;
      }
      if (found >= 0) return -1;
      found = i;
    }
    return found;
  };
  const int a = lone(one, two);
  const int b = lone(two, one);
  if (a < 0 || b < 0) return std::nullopt;
  const auto corner = [&](const std::array<uint32_t, 3>& triangle, int i) {
    const Vec3 local = mesh.positions[triangle[static_cast<size_t>(i % 3)]];
    return Vec3d(glm::dmat4(placement.to_world[0]) * glm::dvec4(Vec3d(local), 1.0));
  };
  Rectangle r;
  r.corner = corner(one, a);
  r.edge[0] = corner(one, a + 1) - r.corner;
  r.edge[1] = corner(one, a + 2) - r.corner;
  const double size2 = glm::dot(r.edge[0], r.edge[0]) + glm::dot(r.edge[1], r.edge[1]);
  const double slant = glm::dot(r.edge[0], r.edge[1]);
  const double gap = length(corner(two, b) - r.corner - r.edge[0] - r.edge[1]);
  constexpr double kEven = 1e-6;  // what still is a rectangle, in parts of its size
  const double shortest = std::min(glm::dot(r.edge[0], r.edge[0]), glm::dot(r.edge[1], r.edge[1]));
  if (!(std::abs(slant) <= kEven * shortest) || !(gap * gap <= kEven * kEven * shortest) ||
      !(shortest > 1e-8 * size2)) {
    return std::nullopt;
  }
  r.corners[0] = {a, (a + 1) % 3, (a + 2) % 3};
  const auto slot_in_two = [&](int of_one) {
    return static_cast<int>(std::find(two.begin(), two.end(), one[static_cast<size_t>(of_one)]) -
                            two.begin());
  };
  r.corners[1] = {b, slot_in_two(r.corners[0][2]), slot_in_two(r.corners[0][1])};
  for (uint32_t triangle = 0; triangle < 2; ++triangle) {
    for (int i = 0; i < 3; ++i) {
      const SurfacePoint p =
          world.triangle_point(object, triangle, i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F, 0.0F);
      if (triangle == 1 && !(glm::dot(p.ng, r.ng) > 0.0F)) return std::nullopt;
      r.ng = p.ng;
      r.clearance = std::max(r.clearance, p.clearance);
    }
  }
  return r;
}

namespace {

BrightnessGrid brightness_of(const World& world, uint32_t object, const Rectangle& rectangle,
                             const SurfaceEmission& emission) {
  if (!emission.varies()) return {};
  const auto at = [&](const Vec2& u) {
    return emission.brightness(rectangle_point(world, object, rectangle, u, 0.0F));
  };
  return {at, emission.look_ups};
}

}  // namespace

RectangleLight::RectangleLight(const World& world, uint32_t object, const Rectangle& rectangle,
                               const SurfaceEmission& emission, double area)
    : RectangleLight(world, object, rectangle, emission, area,
                     brightness_of(world, object, rectangle, emission)) {}

RectangleLight::RectangleLight(const World& world, uint32_t object, const Rectangle& rectangle,
                               const SurfaceEmission& emission, double area, BrightnessGrid bright)
    : AreaLight(emission,
                area * (emission.varies() ? bright.mean()
                                          : static_cast<double>(luminance(emission.radiance)))),
      world_(world),
      object_(object),
      rectangle_(rectangle),
      width_(length(rectangle.edge[0])),
      height_(length(rectangle.edge[1])),
      bright_(std::move(bright)) {
  x_ = rectangle.edge[0] / width_;
  y_ = rectangle.edge[1] / height_;
  z_ = glm::cross(x_, y_);
}

bool RectangleLight::is_near(double x0, double y0, double z0) const {
  const double dx = std::max({x0, -(x0 + width_), 0.0});
  const double dy = std::max({y0, -(y0 + height_), 0.0});
  return width_ * height_ > kLeastExtent * (dx * dx + dy * dy + z0 * z0);
}

std::optional<SphericalRectangle> RectangleLight::seen_nearby(const Vec3& from) const {
  const Vec3d to_corner = rectangle_.corner - Vec3d(from);
  const double x0 = glm::dot(to_corner, x_);
  const double y0 = glm::dot(to_corner, y_);
  const double z0 = glm::dot(to_corner, z_);
  // From within its plane the whole hemisphere would be places that are too near to tell apart.
  const bool in_plane = std::abs(z0) <= 2.0 * static_cast<double>(rectangle_.clearance);
  if (in_plane || !is_near(x0, y0, z0)) return std::nullopt;
  const SphericalRectangle seen(x0, x0 + width_, y0, y0 + height_, z0);
  return seen.solid_angle > kLeastSolidAngle ? std::optional(seen) : std::nullopt;
}

std::optional<LightSample> RectangleLight::sample_direct(const Vec3& from, float time,
                                                         float /*pick*/, const Vec2& u) const {
  if (is_dark()) return std::nullopt;
  const std::optional<SphericalRectangle> seen = seen_nearby(from);
  if (emission().varies()) return sample_bright(from, time, seen, u);
  if (!seen) return seen_from(from, place_at(u), rectangle_.ng, rectangle_.clearance, pdf_area());
  const glm::dvec2 place = seen->place(u);
  const Vec3d position = rectangle_.corner + x_ * (place.x - seen->x0) + y_ * (place.y - seen->y0);
  auto sample = seen_from(from, Vec3(position), rectangle_.ng, rectangle_.clearance, pdf_area());
  if (sample) sample->pdf = static_cast<float>(1.0 / seen->solid_angle);
  return sample;
}

std::optional<LightSample> RectangleLight::sample_bright(
    const Vec3& from, float time, const std::optional<SphericalRectangle>& seen,
    const Vec2& u) const {
  const bool by_angle = seen && u.x < 0.5F;
  const Vec2 left = seen ? Vec2(by_angle ? 2.0F * u.x : 2.0F * u.x - 1.0F, u.y) : u;
  Vec2 at(0.0F);
  if (by_angle) {
    const glm::dvec2 place = seen->place(left);
    at = {static_cast<float>((place.x - seen->x0) / width_),
          static_cast<float>((place.y - seen->y0) / height_)};
  } else {
    at = bright_.sample(left);
  }
  const Place place = place_on(at, time);
  auto sample = seen_from(from, place);
  if (sample && seen)
    sample->pdf = 0.5F * (sample->pdf + static_cast<float>(1.0 / seen->solid_angle));
  return sample;
}

Vec3 RectangleLight::place_at(const Vec2& u) const {
  return Vec3(rectangle_.corner + rectangle_.edge[0] * static_cast<double>(u.x) +
              rectangle_.edge[1] * static_cast<double>(u.y));
}

AreaLight::Place RectangleLight::place_on(const Vec2& at, float time) const {
  Place place;
  place.on = rectangle_point(world_, object_, rectangle_, at, time);
  place.pdf = pdf_place(place.on, Vec3(0.0F));
  return place;
}

std::optional<AreaLight::Place> RectangleLight::choose_place(float time, float /*pick*/,
                                                             const Vec2& u) const {
  if (emission().varies()) return place_on(bright_.sample(u), time);
  Place place;
  place.on.position = place_at(u);
  place.on.ng = rectangle_.ng;
  place.on.clearance = rectangle_.clearance;
  place.on.time = time;
  place.pdf = pdf_area();
  return place;
}

float RectangleLight::pdf_place(const SurfacePoint& on, const Vec3& /*direction*/) const {
  if (is_dark()) return 0.0F;
  if (!emission().varies()) return pdf_area();
  const Vec3d from_corner = Vec3d(on.position) - rectangle_.corner;
  return pdf_area() * bright_.pdf({static_cast<float>(glm::dot(from_corner, x_) / width_),
                                   static_cast<float>(glm::dot(from_corner, y_) / height_)});
}

float RectangleLight::pdf_direct(const Vec3& from, const Vec3& direction,
                                 const SurfacePoint& on) const {
  if (is_dark()) return 0.0F;
  const std::optional<SphericalRectangle> seen = seen_nearby(from);
  const auto by_angle = seen ? static_cast<float>(1.0 / seen->solid_angle) : 0.0F;
  if (seen && !emission().varies()) return by_angle;
  const float by_place = area_to_solid_angle(pdf_place(on, direction), from, on.position, on.ng);
  return seen ? 0.5F * (by_place + by_angle) : by_place;
}

SurfacePoint rectangle_point(const World& world, uint32_t object, const Rectangle& rectangle,
                             const Vec2& at, float time) {
  const bool far_half = at.x + at.y > 1.0F;
  const std::array<int, 3>& corners = rectangle.corners[far_half ? 1 : 0];
  const float a = far_half ? 1.0F - at.x : at.x;
  const float b = far_half ? 1.0F - at.y : at.y;
  float weights[3] = {};
  weights[corners[0]] = 1.0F - a - b;
  weights[corners[1]] = a;
  weights[corners[2]] = b;
  return world.triangle_point(object, far_half ? 1 : 0, weights[1], weights[2], time);
}

}  // namespace hyades::core
