#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/matrix_inverse.hpp>

#include "core/base/elementary.h"
#include "core/lights/elliptic.h"
#include "core/lights/make_light.h"
#include "core/lights/mesh_light.h"
#include "core/lights/quadric_light.h"
#include "core/lights/rectangle_light.h"

namespace hyades::core {

namespace {

/// Eigenvalues of a symmetric matrix by Jacobi's rotations (Golub & Van Loan 2013, section 8.5).
std::array<double, 3> eigenvalues(glm::dmat3 a) {
  constexpr std::array<std::array<int, 2>, 3> kPairs{{{0, 1}, {0, 2}, {1, 2}}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (const auto& [p, q] : kPairs) {
      if (a[p][q] == 0.0) continue;
      const double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
      const double t = (tau >= 0.0 ? 1.0 : -1.0) / (std::abs(tau) + std::sqrt(1.0 + tau * tau));
      const double c = 1.0 / std::sqrt(1.0 + t * t);
      const double s = t * c;
      glm::dmat3 turn(1.0);
      turn[p][p] = c;
      turn[q][q] = c;
      turn[q][p] = s;
      turn[p][q] = -s;
      a = glm::transpose(turn) * a * turn;
    }
  }
  return {std::max(a[0][0], 0.0), std::max(a[1][1], 0.0), std::max(a[2][2], 0.0)};
}

/// An ellipsoid's area from the squares of its half axes' products, which are the eigenvalues of
/// C^T C with the cofactor matrix C of the map that makes it of the unit sphere.
double ellipsoid_area(const glm::dmat3& m) {
  const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const std::array<double, 3> e = eigenvalues(glm::transpose(cofactor) * cofactor);
  return 4.0 * elementary::kPiD * carlson_rg(e[0], e[1], e[2]);
}

/// The area of a tube is the perimeter of its shadow along the axis, an ellipse, times the length
/// of the axis.
double tube_area(const glm::dmat3& m, double radius, double height) {
  const double axis = std::sqrt(glm::dot(m[1], m[1]));
  if (!(axis > 0.0)) return 0.0;
  const Vec3d along = m[1] / axis;
  const Vec3d x = m[0] - along * glm::dot(along, m[0]);
  const Vec3d z = m[2] - along * glm::dot(along, m[2]);
  // Half axes squared: eigenvalues of the 2 x 2 matrix of scalar products.
  const double mean = 0.5 * (glm::dot(x, x) + glm::dot(z, z));
  const double half = 0.5 * (glm::dot(x, x) - glm::dot(z, z));
  const double mixed = glm::dot(x, z);
  const double spread = std::sqrt(half * half + mixed * mixed);
  const double perimeter =
      8.0 * radius * carlson_rg(0.0, std::max(mean - spread, 0.0), mean + spread);
  return perimeter * axis * height;
}

MeshAreas mesh_areas(const Shape& shape, const Mat3& linear) {
  MeshAreas areas;
  areas.triangles.reserve(shape.mesh->triangles.size());
  for (uint32_t i = 0; i < shape.mesh->triangles.size(); ++i) {
    const double area = triangle_area(shape, i, 0.0F, linear);
    areas.triangles.push_back(static_cast<float>(area));
    areas.total += area;
  }
  return areas;
}

}  // namespace

double surface_area(const World& world, uint32_t object) {
  const Shape& shape = world.placement(object).shape;
  const Mat3 linear(world.transform_at(object, 0.0F));
  const glm::dmat3 m(linear);
  const double radius = double{shape.radius};
  switch (shape.kind) {
    case Shape::Kind::sphere:
      return radius * radius * ellipsoid_area(m);
    case Shape::Kind::disk: {
      const Vec3d normal = glm::cross(m[2], m[0]);
      return elementary::kPiD * radius * radius * std::sqrt(glm::dot(normal, normal));
    }
    case Shape::Kind::cylinder:
      return tube_area(m, radius, double{shape.height});
    case Shape::Kind::mesh:
    case Shape::Kind::curves:  // which do not shine
      break;
  }
  return mesh_areas(shape, linear).total;
}

namespace {

std::shared_ptr<AreaLight> light_of_its_kind(const World& world, uint32_t object,
                                             const SurfaceEmission& emission) {
  const Shape& shape = world.placement(object).shape;
  if (shape.kind == Shape::Kind::mesh) {
    if (const auto rectangle = find_rectangle(world, object)) {
      return std::make_shared<RectangleLight>(world, object, *rectangle, emission,
                                              surface_area(world, object));
    }
    const MeshAreas areas = mesh_areas(shape, Mat3(world.transform_at(object, 0.0F)));
    return std::make_shared<MeshLight>(world, object, emission, areas);
  }
  const double area = surface_area(world, object);
  if (shape.kind == Shape::Kind::sphere) {
    return std::make_shared<SphereLight>(world, object, emission, area);
  }
  return std::make_shared<QuadricLight>(world, object, emission, area);
}

/// The outer normals of a placement while the shutter is open. Motion that turns or stretches, and
/// what deforms, may have any.
DirectionCone outer_normals(const World& world, uint32_t object) {
  const Placement& placement = world.placement(object);
  if (placement.shape.deforms()) return {};
  for (const Mat4& matrix : placement.to_world) {
    if (Mat3(matrix) != Mat3(placement.to_world[0])) return {};
  }
  const Shape& shape = placement.shape;
  if (shape.kind == Shape::Kind::disk) {
    const Mat3 linear(placement.to_world[0]);
    return {glm::normalize(glm::inverseTranspose(linear) * Vec3(0.0F, 1.0F, 0.0F)), 1.0F};
  }
  if (shape.kind != Shape::Kind::mesh) return {};
  const auto count = static_cast<uint32_t>(shape.mesh->triangles.size());
  const auto normal_of = [&](uint32_t triangle) {
    return world.triangle_point(object, triangle, 0.3F, 0.3F, 0.0F).ng;
  };
  Vec3d sum(0.0);
  for (uint32_t i = 0; i < count; ++i) sum += Vec3d(normal_of(i));
  const double length = std::sqrt(glm::dot(sum, sum));
  if (!(length > 1e-3 * count)) return {};
  DirectionCone normals{Vec3(sum / length), 1.0F};
  for (uint32_t i = 0; i < count; ++i)
    normals.cosine = std::min(normals.cosine, glm::dot(normals.axis, normal_of(i)));
  constexpr float kRounding = 1e-5F;
  normals.cosine -= normals.cosine < 1.0F - kRounding ? kRounding : 0.0F;
  return normals;
}

void place(const World& world, uint32_t object, AreaLight& light) {
  const Placement& placement = world.placement(object);
  const Bounds bounds = bounds_of(placement.shape);
  if (bounds.empty()) return;
  light.set_middle(transform_point(world.transform_at(object, 0.0F), bounds.center()));
  Bounds box;  // places move straight from one moment to the next
  for (const Mat4& matrix : placement.to_world) {
    for (int corner = 0; corner < 8; ++corner) {
      box.include(transform_point(matrix, {(corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                                           (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                                           (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z}));
    }
  }
  light.set_surface(box, outer_normals(world, object));
}

}  // namespace

LightPtr make_area_light(const World& world, uint32_t object, const SurfaceEmission& emission) {
  return make_area_lights(world, std::array{object}, emission, std::nullopt)[0];
}

std::vector<LightPtr> make_area_lights(const World& world, std::span<const uint32_t> parts,
                                       const SurfaceEmission& emission,
                                       std::optional<float> power) {
  std::vector<std::shared_ptr<AreaLight>> lights;
  double found = 0.0;
  for (const uint32_t part : parts) {
    lights.push_back(light_of_its_kind(world, part, emission));
    found += static_cast<double>(lights.back()->power());
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    if (power) lights[i]->scale(found > 0.0 ? static_cast<float>(double{*power} / found) : 0.0F);
    place(world, parts[i], *lights[i]);
  }
  return {lights.begin(), lights.end()};
}

}  // namespace hyades::core
