#include "core/lights/mesh_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/warp.h"

namespace hyades::core {

namespace {

/// Mean brightness of a triangle, looked up at n x n places.
double mean_brightness(const World& world, uint32_t object, uint32_t triangle,
                       const SurfaceEmission& emission, int n) {
  double sum = 0.0;
  for (int i = 0; i < n * n; ++i) {
    const Vec2 b = square_to_triangle((Vec2(i % n, i / n) + 0.5F) / static_cast<float>(n));
    sum += emission.brightness(world.triangle_point(object, triangle, b.x, b.y, 0.0F));
  }
  return sum / (static_cast<double>(n) * n);
}

}  // namespace

MeshLight::MeshLight(const World& world, uint32_t object, const SurfaceEmission& emission,
                     const MeshAreas& areas)
    : MeshLight(world, object, emission, measure(world, object, emission, areas)) {}

MeshLight::MeshLight(const World& world, uint32_t object, const SurfaceEmission& emission,
                     const Brightness& bright)
    : AreaLight(emission, bright.total),
      world_(world),
      object_(object),
      triangles_(bright.weights),
      matrix_(world.transform_at(object, 0.0F)),
      moves_(world.placement(object).to_world.size() > 1) {}

MeshLight::Brightness MeshLight::measure(const World& world, uint32_t object,
                                         const SurfaceEmission& emission, const MeshAreas& areas) {
  if (!emission.varies()) {
    return {areas.triangles, static_cast<double>(luminance(emission.radiance)) * areas.total};
  }
  const auto count = static_cast<uint32_t>(areas.triangles.size());
  const double least = 4.0 * count <= emission.look_ups ? 2.0 : 1.0;
  Brightness bright;
  bright.weights.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const double area = static_cast<double>(areas.triangles[i]);
    const double part = areas.total > 0.0 ? area / areas.total : 0.0;
    const double n = std::sqrt(part * emission.look_ups);
    const double shining = area * mean_brightness(world, object, i, emission,
                                                  static_cast<int>(std::clamp(n, least, 512.0)));
    bright.weights.push_back(static_cast<float>(shining));
    bright.total += shining;
  }
  for (uint32_t i = 0; i < count && bright.total > 0.0; ++i) {
    const double even = bright.total * static_cast<double>(areas.triangles[i]) / areas.total;
    bright.weights[i] = static_cast<float>(
        (1.0 - kEvenPart) * static_cast<double>(bright.weights[i]) + kEvenPart * even);
  }
  return bright;
}

std::optional<LightSample> MeshLight::sample_direct(const Vec3& from, float time, float pick,
                                                    const Vec2& u) const {
  if (is_dark()) return std::nullopt;
  const std::optional<Place> place = choose_place(time, pick, u);
  if (!place) return std::nullopt;
  return seen_from(from, *place);
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
  const double area = triangle_area(world_.placement(object_).shape, triangle, time, linear);
  return area > 0.0 ? static_cast<float>(double{triangles_.probability(triangle)} / area) : 0.0F;
}

double triangle_area(const Shape& shape, uint32_t triangle, float time, const Mat3& linear) {
  const auto [a, b, c] = shape.corners_at(triangle, time);
  const glm::dmat3 m(linear);
  const Vec3d normal = glm::cross(m * (b - a), m * (c - a));
  return 0.5 * std::sqrt(glm::dot(normal, normal));
}

}  // namespace hyades::core
