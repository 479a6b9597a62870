#include "import/pbrt/made_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>

namespace hyades::core::pbrt {
namespace {

constexpr int kAround = 128;
constexpr int kSphereRows = kAround / 2;

struct Parametric {
  Vec3d position;
  Vec3d normal;
};

/// A grid of u and v from 0 to 1, `columns` x `rows` cells.
TriangleMesh grid(int columns, int rows, const std::function<Parametric(double, double)>& at) {
  TriangleMesh mesh;
  for (int y = 0; y <= rows; ++y) {
    for (int x = 0; x <= columns; ++x) {
      const double u = static_cast<double>(x) / columns;
      const double v = static_cast<double>(y) / rows;
      const Parametric s = at(u, v);
      mesh.positions.emplace_back(s.position);
      mesh.normals.emplace_back(s.normal);
      mesh.uvs.emplace_back(u, v);
    }
  }
  const auto row = static_cast<uint32_t>(columns + 1);
  for (uint32_t y = 0; y < static_cast<uint32_t>(rows); ++y) {
    for (uint32_t x = 0; x < static_cast<uint32_t>(columns); ++x) {
      const uint32_t a = y * row + x;
      for (std::array<uint32_t, 3> t :
           {std::array<uint32_t, 3>{a, a + 1, a + row + 1}, {a, a + row + 1, a + row}}) {
        const auto& p = mesh.positions;
        const Vec3 across = glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
        if (across == Vec3(0.0F)) continue;  // at a pole
        const Vec3 normal = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
        if (glm::dot(across, normal) < 0.0F) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
      }
    }
  }
  return mesh;
}

struct Ranges {
  double radius, low, high, turn, inner;
};

Ranges extent_of(const ShapeEntity& shape, Report& report) {
  ParameterReader reader(shape.parameters, shape.place, report);
  Ranges e{};
  const float radius = reader.number("radius", 1.0F);
  e.radius = static_cast<double>(radius);
  const bool ball = shape.type == "sphere";
  const float low = reader.number("zmin", ball ? -radius : -1.0F);
  const float high = reader.number("zmax", ball ? radius : 1.0F);
  e.low = static_cast<double>(std::min(low, high));
  e.high = static_cast<double>(std::max(low, high));
  e.turn = std::clamp(static_cast<double>(reader.number("phimax", 360.0F)), 0.0, 360.0) *
           std::numbers::pi / 180.0;
  e.inner = static_cast<double>(reader.number("innerradius", 0.0F));
  if (shape.type == "disk") e.low = static_cast<double>(reader.number("height", 0.0F));
  return e;
}

int columns_of(const Ranges& e) {
  return std::max(1, static_cast<int>(std::ceil(kAround * e.turn / (2 * std::numbers::pi))));
}

}  // namespace

bool needs_tessellation(const ShapeEntity& shape) {
  if (shape.type != "sphere" && shape.type != "disk" && shape.type != "cylinder") return false;
  Report unheard;
  const Ranges e = extent_of(shape, unheard);
  if (e.turn < 2.0 * std::numbers::pi - 1e-9) return true;
  if (shape.type == "disk") return e.inner > 0.0;
  if (shape.type == "cylinder") return shape.reversed;
  return shape.reversed || e.low > -e.radius || e.high < e.radius;
}

uint64_t tessellated_triangles(const ShapeEntity& shape) {
  Report unheard;
  const auto columns = static_cast<uint64_t>(columns_of(extent_of(shape, unheard)));
  return 2 * columns * (shape.type == "sphere" ? kSphereRows : 1);
}

Result<TriangleMesh> tessellated_mesh(const ShapeEntity& shape, Report& report) {
  const Ranges e = extent_of(shape, report);
  if (!(e.radius > 0.0)) return shape.place.error("the radius is not above 0");
  if (!(e.turn > 0.0)) return shape.place.error("phimax is not above 0");
  const int columns = columns_of(e);
  if (shape.type == "sphere") {
    const double first = std::acos(std::clamp(e.low / e.radius, -1.0, 1.0));
    const double last = std::acos(std::clamp(e.high / e.radius, -1.0, 1.0));
    return grid(columns, kSphereRows, [&](double u, double v) {
      const double theta = std::lerp(first, last, v);
      const Vec3d n(std::sin(theta) * std::cos(u * e.turn), std::sin(theta) * std::sin(u * e.turn),
                    std::cos(theta));
      return Parametric{e.radius * n, n};
    });
  }
  if (shape.type == "cylinder") {
    return grid(columns, 1, [&](double u, double v) {
      const Vec3d n(std::cos(u * e.turn), std::sin(u * e.turn), 0.0);
      return Parametric{e.radius * n + Vec3d(0.0, 0.0, std::lerp(e.low, e.high, v)), n};
    });
  }
  // v grows towards the middle.
  return grid(columns, 1, [&](double u, double v) {
    const double r = std::lerp(e.radius, e.inner, v);
    return Parametric{{r * std::cos(u * e.turn), r * std::sin(u * e.turn), e.low}, {0.0, 0.0, 1.0}};
  });
}

}  // namespace hyades::core::pbrt
