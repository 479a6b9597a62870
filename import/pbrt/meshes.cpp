#include "import/pbrt/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "import/pbrt/made_meshes.h"

namespace hyades::core::pbrt {
namespace {

using Triangle = std::array<uint32_t, 3>;

constexpr uint32_t kCuts = 8;  ///< of a bent patch, along each side

/// The lists that meshes are made of, with indices in range.
struct Lists {
  std::span<const float> positions;  ///< 3 each
  std::span<const float> normals;    ///< 3 each, or none
  std::span<const float> uvs;        ///< 2 each, or none
  std::span<const int32_t> indices;
};

/// `corners` vertices make a face.
Result<Lists> lists_of(const ShapeEntity& shape, size_t corners, Report& report) {
  const size_t errors = report.errors.size();
  ParameterReader reader(shape.parameters, shape.place, report);
  Lists out;
  out.positions = reader.numbers("point3", "P", 3);
  out.normals = reader.numbers("normal", "N", 3);
  out.uvs = reader.numbers("point2", "uv", 2);
  if (out.uvs.empty()) out.uvs = reader.numbers("point2", "st", 2);
  out.indices = reader.integers("indices", corners);
  if (report.errors.size() > errors) return Error{report.errors.back()};
  const size_t n = out.positions.size() / 3;
  if (n == 0) return shape.place.error("the mesh has no positions: \"point3 P\"");
  if (!out.normals.empty() && out.normals.size() / 3 != n) {
    return shape.place.error("the mesh has " + format_count(n) + " positions and " +
                             format_count(out.normals.size() / 3) + " normals");
  }
  if (!out.uvs.empty() && out.uvs.size() / 2 != n) {
    return shape.place.error("the mesh has " + format_count(n) + " positions and " +
                             format_count(out.uvs.size() / 2) + " uvs");
  }
  static constexpr std::array<int32_t, 4> kOneFace{0, 1, 2, 3};
  if (out.indices.empty()) {
    if (n != corners) return shape.place.error("the mesh has no indices: \"integer indices\"");
    out.indices = std::span(kOneFace).first(corners);
  }
  for (const int32_t index : out.indices) {
    if (index < 0 || static_cast<size_t>(index) >= n) {
      return shape.place.error("index " + std::to_string(index) + " is none of the mesh's " +
                               format_count(n) + " vertices");
    }
  }
  return out;
}

Vec3 triple(std::span<const float> list, size_t i) {
  return {list[3 * i], list[3 * i + 1], list[3 * i + 2]};
}

void take_vertices(const Lists& lists, TriangleMesh& mesh) {
  const size_t n = lists.positions.size() / 3;
  mesh.positions.reserve(n + 1);
  for (size_t i = 0; i < n; ++i) mesh.positions.push_back(triple(lists.positions, i));
  for (size_t i = 0; i < lists.normals.size() / 3; ++i) {
    const Vec3 normal = triple(lists.normals, i);
    const float length = glm::length(normal);
    mesh.normals.push_back(length > 0.0F ? normal / length : Vec3(0.0F));
  }
  for (size_t i = 0; i < lists.uvs.size() / 2; ++i) {
    mesh.uvs.emplace_back(lists.uvs[2 * i], lists.uvs[2 * i + 1]);
  }
}

/// The side that normals point to is the outer one, whatever way a triangle's corners go round.
void turn_to_normals(TriangleMesh& mesh) {
  if (mesh.normals.empty()) return;
  for (Triangle& t : mesh.triangles) {
    const Vec3 across = glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                   mesh.positions[t[2]] - mesh.positions[t[0]]);
    const Vec3 normal = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    if (glm::dot(across, normal) < 0.0F) std::swap(t[1], t[2]);
  }
}

Result<TriangleMesh> triangle_mesh(const ShapeEntity& shape, Report& report) {
  auto lists = lists_of(shape, 3, report);
  if (!lists) return lists.error();
  TriangleMesh mesh;
  take_vertices(*lists, mesh);
  mesh.triangles.reserve(lists->indices.size() / 3);
  for (size_t i = 0; i < lists->indices.size(); i += 3) {
    mesh.triangles.push_back({static_cast<uint32_t>(lists->indices[i]),
                              static_cast<uint32_t>(lists->indices[i + 1]),
                              static_cast<uint32_t>(lists->indices[i + 2])});
  }
  turn_to_normals(mesh);
  return mesh;
}

/// Each patch by itself: (1 - v) ((1 - u) a + u b) + v ((1 - u) c + u d).
Result<TriangleMesh> bilinear_mesh(const ShapeEntity& shape, Report& report) {
  auto lists = lists_of(shape, 4, report);
  if (!lists) return lists.error();
  TriangleMesh from;
  take_vertices(*lists, from);
  TriangleMesh mesh;
  for (size_t i = 0; i < lists->indices.size(); i += 4) {
    std::array<uint32_t, 4> corner{};
    for (size_t k = 0; k < 4; ++k) corner[k] = static_cast<uint32_t>(lists->indices[i + k]);
    const auto mixed = [&](const auto& values, float u, float v) {
      return glm::mix(glm::mix(values[corner[0]], values[corner[1]], u),
                      glm::mix(values[corner[2]], values[corner[3]], u), v);
    };
    const auto& p = from.positions;
    const Vec3 twist = p[corner[0]] - p[corner[1]] - p[corner[2]] + p[corner[3]];
    const float size =
        glm::length(p[corner[3]] - p[corner[0]]) + glm::length(p[corner[2]] - p[corner[1]]);
    // Parallelograms are two triangles; what is bent is cut.
    const uint32_t cuts = glm::length(twist) > 1e-4F * size ? kCuts : 1;
    if (mesh.positions.size() > std::numeric_limits<int32_t>::max() - 100) {
      return shape.place.error("the patches are too many");
    }
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t y = 0; y <= cuts; ++y) {
      for (uint32_t x = 0; x <= cuts; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(cuts);
        const float v = static_cast<float>(y) / static_cast<float>(cuts);
        mesh.positions.push_back(mixed(p, u, v));
        mesh.uvs.push_back(from.uvs.empty() ? Vec2(u, v) : mixed(from.uvs, u, v));
        if (!from.normals.empty()) mesh.normals.push_back(mixed(from.normals, u, v));
      }
    }
    const uint32_t row = cuts + 1;
    for (uint32_t y = 0; y < cuts; ++y) {
      for (uint32_t x = 0; x < cuts; ++x) {
        const uint32_t a = first + y * row + x;
        mesh.triangles.push_back({a, a + 1, a + row + 1});
        mesh.triangles.push_back({a, a + row + 1, a + row});
      }
    }
  }
  for (Vec3& n : mesh.normals) {
    const float length = glm::length(n);
    n = length > 0.0F ? n / length : Vec3(0.0F);
  }
  turn_to_normals(mesh);
  return mesh;
}

}  // namespace

Result<TriangleMesh> control_mesh(const ShapeEntity& shape, Report& report) {
  return triangle_mesh(shape, report);
}

bool is_made_mesh(const ShapeEntity& shape) {
  return shape.type == "trianglemesh" || shape.type == "bilinearmesh" ||
         shape.type == "loopsubdiv" || (shape.type == "curve" && !is_strand(shape)) ||
         needs_tessellation(shape);
}

Result<TriangleMesh> mesh_of(const ShapeEntity& shape, Report& report) {
  Result<TriangleMesh> mesh = Error{};
  if (shape.type == "trianglemesh") {
    mesh = triangle_mesh(shape, report);
  } else if (shape.type == "bilinearmesh") {
    mesh = bilinear_mesh(shape, report);
  } else if (shape.type == "loopsubdiv") {
    mesh = subdivided_mesh(shape, report);
  } else if (shape.type == "curve") {
    mesh = curve_mesh(shape, report);
  } else {
    mesh = tessellated_mesh(shape, report);
  }
  if (mesh.ok() && shape.reversed) reverse(*mesh);
  return mesh;
}

Result<uint64_t> check_mesh(const ShapeEntity& shape, Report& report) {
  const bool patches = shape.type == "bilinearmesh";
  if (patches || shape.type == "trianglemesh") {
    const size_t corners = patches ? 4 : 3;
    auto lists = lists_of(shape, corners, report);
    if (!lists) return lists.error();
    const uint64_t each = patches ? uint64_t{2} * kCuts * kCuts : 1;
    return std::max<uint64_t>(each * lists->indices.size() / corners, lists->positions.size() / 3);
  }
  if (shape.type == "loopsubdiv") return check_subdivision(shape, report);
  if (shape.type == "curve") return check_curve(shape, report);
  return tessellated_triangles(shape);
}

void reverse(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Vec3& n : mesh.normals) n = -n;
}

}  // namespace hyades::core::pbrt
