#include "core/lights/mesh_light.h"

#include <array>
#include <cmath>

#include "core/base/warp.h"

namespace hyades::core {

MeshLight::MeshLight(const World& world, uint32_t object, const Rgb& radiance, bool two_sided,
                     const std::vector<float>& areas, double total)
    : AreaLight(radiance, two_sided, total),
      world_(world),
      object_(object),
      triangles_(areas),
      matrix_(world.transform_at(object, 0.0F)),
      moves_(world.placement(object).to_world.size() > 1) {}

std::optional<LightSample> MeshLight::sample_direct(const Vec3& from, float time, float pick,
                                                    const Vec2& u) const {
  if (is_dark()) return std::nullopt;
  const std::optional<Place> place = choose_place(time, pick, u);
  if (!place) return std::nullopt;
  const SurfacePoint& on = place->on;
  return seen_from(from, on.position, on.ng, on.clearance, place->pdf);
}

std::optional<AreaLight::Place> MeshLight::choose_place(float time, float pick,
                                                        const Vec2& u) const {
  if (triangles_.empty()) return std::nullopt;
  const Distribution1D::Choice choice = triangles_.sample(pick);
  const Vec2 b = square_to_triangle(u);
  return Place{world_.triangle_point(object_, choice.index, b.x, b.y, time),
               pdf_area(choice.index, time)};
}

float MeshLight::pdf_direct(const Vec3& from, const Vec3& /*direction*/,
                            const SurfacePoint& on) const {
  if (is_dark() || triangles_.empty()) return 0.0F;
  return area_to_solid_angle(pdf_area(on.primitive, on.time), from, on.position, on.ng);
}

float MeshLight::pdf_place(const SurfacePoint& on, const Vec3& /*direction*/) const {
  return is_dark() || triangles_.empty() ? 0.0F : pdf_area(on.primitive, on.time);
}

float MeshLight::pdf_area(uint32_t triangle, float time) const {
  const Mat3 linear(moves_ ? world_.transform_at(object_, time) : matrix_);
  const double area = triangle_area(*world_.placement(object_).shape.mesh, triangle, linear);
  return area > 0.0 ? static_cast<float>(double{triangles_.probability(triangle)} / area) : 0.0F;
}

double triangle_area(const TriangleMesh& mesh, uint32_t triangle, const Mat3& linear) {
  const std::array<uint32_t, 3>& corners = mesh.triangles[triangle];
  const Vec3d a(mesh.positions[corners[0]]);
  const Vec3d b(mesh.positions[corners[1]]);
  const Vec3d c(mesh.positions[corners[2]]);
  const glm::dmat3 m(linear);
  const Vec3d normal = glm::cross(m * (b - a), m * (c - a));
  return 0.5 * std::sqrt(glm::dot(normal, normal));
}

}  // namespace hyades::core
