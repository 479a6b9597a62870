#include <algorithm>
#include <array>
#include <cmath>

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

struct MeshAreas {
  std::vector<float> triangles;
  double total = 0.0;
};

MeshAreas mesh_areas(const TriangleMesh& mesh, const Mat3& linear) {
  MeshAreas areas;
  areas.triangles.reserve(mesh.triangles.size());
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const double area = triangle_area(mesh, i, linear);
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
      break;
  }
  return mesh_areas(*shape.mesh, linear).total;
}

namespace {

std::shared_ptr<AreaLight> light_of_its_kind(const World& world, uint32_t object,
                                             const Rgb& radiance, bool two_sided) {
  const Shape& shape = world.placement(object).shape;
  if (shape.kind == Shape::Kind::mesh) {
    if (const auto rectangle = find_rectangle(world, object)) {
      return std::make_shared<RectangleLight>(*rectangle, radiance, two_sided,
                                              surface_area(world, object));
    }
    const MeshAreas areas = mesh_areas(*shape.mesh, Mat3(world.transform_at(object, 0.0F)));
    return std::make_shared<MeshLight>(world, object, radiance, two_sided, areas.triangles,
                                       areas.total);
  }
  const double area = surface_area(world, object);
  if (shape.kind == Shape::Kind::sphere) {
    return std::make_shared<SphereLight>(world, object, radiance, two_sided, area);
  }
  return std::make_shared<QuadricLight>(world, object, radiance, two_sided, area);
}

}  // namespace

LightPtr make_area_light(const World& world, uint32_t object, const Rgb& radiance, bool two_sided) {
  const std::shared_ptr<AreaLight> light = light_of_its_kind(world, object, radiance, two_sided);
  const Bounds bounds = bounds_of(world.placement(object).shape);
  if (!bounds.empty())
    light->set_middle(transform_point(world.transform_at(object, 0.0F), bounds.center()));
  return light;
}

}  // namespace hyades::core
