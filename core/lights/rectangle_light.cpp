#include "core/lights/rectangle_light.h"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

std::optional<Rectangle> find_rectangle(const World& world, uint32_t object) {
  const Placement& placement = world.placement(object);
  if (placement.shape.kind != Shape::Kind::mesh || placement.to_world.size() != 1) {
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

RectangleLight::RectangleLight(const Rectangle& rectangle, const Rgb& radiance, bool two_sided,
                               double area)
    : AreaLight(radiance, two_sided, area),
      rectangle_(rectangle),
      width_(length(rectangle.edge[0])),
      height_(length(rectangle.edge[1])) {
  x_ = rectangle.edge[0] / width_;
  y_ = rectangle.edge[1] / height_;
  z_ = glm::cross(x_, y_);
}

bool RectangleLight::is_near(double x0, double y0, double z0) const {
  const double dx = std::max({x0, -(x0 + width_), 0.0});
  const double dy = std::max({y0, -(y0 + height_), 0.0});
  return width_ * height_ > kLeastExtent * (dx * dx + dy * dy + z0 * z0);
}

std::optional<LightSample> RectangleLight::sample_direct(const Vec3& from, float /*time*/,
                                                         float /*pick*/, const Vec2& u) const {
  if (is_dark()) return std::nullopt;
  const Vec3d to_corner = rectangle_.corner - Vec3d(from);
  const double x0 = glm::dot(to_corner, x_);
  const double y0 = glm::dot(to_corner, y_);
  const double z0 = glm::dot(to_corner, z_);
  if (is_near(x0, y0, z0)) {
    const SphericalRectangle seen(x0, x0 + width_, y0, y0 + height_, z0);
    if (seen.solid_angle > kLeastSolidAngle) {
      const glm::dvec2 place = seen.place(u);
      const Vec3d position = rectangle_.corner + x_ * (place.x - x0) + y_ * (place.y - y0);
      auto sample =
          seen_from(from, Vec3(position), rectangle_.ng, rectangle_.clearance, pdf_area());
      if (sample) sample->pdf = static_cast<float>(1.0 / seen.solid_angle);
      return sample;
    }
  }
  return seen_from(from, place_at(u), rectangle_.ng, rectangle_.clearance, pdf_area());
}

Vec3 RectangleLight::place_at(const Vec2& u) const {
  return Vec3(rectangle_.corner + rectangle_.edge[0] * static_cast<double>(u.x) +
              rectangle_.edge[1] * static_cast<double>(u.y));
}

std::optional<AreaLight::Place> RectangleLight::choose_place(float time, float /*pick*/,
                                                             const Vec2& u) const {
  Place place;
  place.on.position = place_at(u);
  place.on.ng = rectangle_.ng;
  place.on.clearance = rectangle_.clearance;
  place.on.time = time;
  place.pdf = pdf_area();
  return place;
}

float RectangleLight::pdf_place(const SurfacePoint& /*on*/, const Vec3& /*direction*/) const {
  return is_dark() ? 0.0F : pdf_area();
}

float RectangleLight::pdf_direct(const Vec3& from, const Vec3& /*direction*/,
                                 const SurfacePoint& on) const {
  if (is_dark()) return 0.0F;
  const Vec3d to_corner = rectangle_.corner - Vec3d(from);
  const double x0 = glm::dot(to_corner, x_);
  const double y0 = glm::dot(to_corner, y_);
  const double z0 = glm::dot(to_corner, z_);
  if (is_near(x0, y0, z0)) {
    const SphericalRectangle seen(x0, x0 + width_, y0, y0 + height_, z0);
    if (seen.solid_angle > kLeastSolidAngle) return static_cast<float>(1.0 / seen.solid_angle);
  }
  return area_to_solid_angle(pdf_area(), from, on.position, on.ng);
}

}  // namespace hyades::core
