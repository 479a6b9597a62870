#include "import/pbrt/made_meshes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "import/pbrt/meshes.h"

namespace hyades::core::pbrt {
namespace {

using Triangle = std::array<uint32_t, 3>;

constexpr uint64_t kMostTriangles = uint64_t{1} << 26;

/// An edge of one or two triangles.
struct Edge {
  uint32_t low, high;       ///< its ends
  uint32_t opposite;        ///< of the first triangle
  uint32_t other_opposite;  ///< of the second one; == opposite where there is none
  uint32_t side;            ///< 3 * triangle + which side, of the first one
  uint32_t other_side;
  bool border = true;
};

/// All edges, and of each triangle's sides the edge it is on.
struct Edges {
  std::vector<Edge> all;
  std::vector<uint32_t> of_side;
};

Result<Edges> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<Edge> sides;
  sides.reserve(3 * triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = triangles[t][k];
      const uint32_t b = triangles[t][(k + 1) % 3];
      const uint32_t c = triangles[t][(k + 2) % 3];
      const auto side = static_cast<uint32_t>(3 * t + k);
      sides.push_back({std::min(a, b), std::max(a, b), c, c, side, side});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side);
  });
  Edges out;
  out.of_side.resize(sides.size());
  for (const Edge& side : sides) {
    const bool again =
        !out.all.empty() && out.all.back().low == side.low && out.all.back().high == side.high;
    if (again) {
      Edge& edge = out.all.back();
      if (!edge.border) return Error{"an edge has more than two triangles"};
      edge.border = false;
      edge.other_opposite = side.opposite;
      edge.other_side = side.side;
    } else {
      out.all.push_back(side);
    }
    out.of_side[side.side] = static_cast<uint32_t>(out.all.size() - 1);
  }
  return out;
}

/// What lies around each vertex.
struct Ring {
  Vec3 sum{0.0F};         ///< of all neighbours
  Vec3 border_sum{0.0F};  ///< of those along the border
  int count = 0;
  bool border = false;
};

std::vector<Ring> rings_of(const std::vector<Vec3>& positions, const Edges& edges) {
  std::vector<Ring> rings(positions.size());
  for (const Edge& edge : edges.all) {
    for (const auto& [at, from] : {std::pair(edge.low, edge.high), {edge.high, edge.low}}) {
      Ring& ring = rings[at];
      ring.sum += positions[from];
      ++ring.count;
      if (!edge.border) continue;
      ring.border = true;
      ring.border_sum += positions[from];
    }
  }
  return rings;
}

/// Warren's weight of each neighbour.
float beta(int valence) {
  return valence == 3 ? 3.0F / 16.0F : 3.0F / (8.0F * static_cast<float>(valence));
}

/// Every vertex moved: by `inner` of its valence towards each neighbour, on the border by `border`.
template <class Inner>
std::vector<Vec3> moved(const std::vector<Vec3>& positions, const std::vector<Ring>& rings,
                        const Inner& inner, float border) {
  std::vector<Vec3> out = positions;
  for (size_t i = 0; i < out.size(); ++i) {
    const Ring& ring = rings[i];
    if (ring.count == 0) continue;
    if (ring.border) {
      out[i] = (1.0F - 2.0F * border) * positions[i] + border * ring.border_sum;
    } else {
      const float weight = inner(ring.count);
      out[i] = (1.0F - static_cast<float>(ring.count) * weight) * positions[i] + weight * ring.sum;
    }
  }
  return out;
}

Status subdivide(TriangleMesh& mesh) {
  auto edges = edges_of(mesh.triangles);
  if (!edges) return edges.error();
  const std::vector<Vec3>& p = mesh.positions;
  std::vector<Vec3> positions = moved(p, rings_of(p, *edges), beta, 1.0F / 8.0F);
  const auto first = static_cast<uint32_t>(positions.size());
  for (const Edge& edge : edges->all) {
    positions.push_back(edge.border ? 0.5F * (p[edge.low] + p[edge.high])
                                    : 0.375F * (p[edge.low] + p[edge.high]) +
                                          0.125F * (p[edge.opposite] + p[edge.other_opposite]));
  }
  std::vector<Triangle> triangles;
  triangles.reserve(4 * mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& old = mesh.triangles[t];
    Triangle middle{};
    for (size_t k = 0; k < 3; ++k) middle[k] = first + edges->of_side[3 * t + k];
    triangles.push_back({old[0], middle[0], middle[2]});
    triangles.push_back({middle[0], old[1], middle[1]});
    triangles.push_back({middle[2], middle[1], old[2]});
    triangles.push_back(middle);
  }
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  return {};
}

}  // namespace

Result<uint64_t> check_subdivision(const ShapeEntity& shape, Report& report) {
  ParameterReader reader(shape.parameters, shape.place, report);
  const int levels = reader.integer("levels", 3);
  if (levels < 0) return shape.place.error("levels are below 0");
  auto base = control_mesh(shape, report);
  if (!base) return base.error();
  uint64_t triangles = base->triangles.size();
  for (int i = 0; i < levels; ++i) {
    triangles *= 4;
    if (triangles > kMostTriangles) {
      return shape.place.error("the subdivided mesh has more than " + format_count(kMostTriangles) +
                               " triangles");
    }
  }
  auto edges = edges_of(base->triangles);
  if (!edges) return shape.place.error(edges.error().message);
  return triangles;
}

Result<TriangleMesh> subdivided_mesh(const ShapeEntity& shape, Report& report) {
  if (const auto checked = check_subdivision(shape, report); !checked) return checked.error();
  auto mesh = control_mesh(shape, report);
  if (!mesh) return mesh;
  mesh->normals.clear();
  mesh->uvs.clear();
  ParameterReader reader(shape.parameters, shape.place, report);
  const int levels = reader.integer("levels", 3);
  for (int i = 0; i < levels; ++i) {
    if (Status s = subdivide(*mesh); !s) return shape.place.error(s.error().message);
  }
  auto edges = edges_of(mesh->triangles);
  if (!edges) return shape.place.error(edges.error().message);
  const auto limit = [](int valence) {
    return 1.0F / (static_cast<float>(valence) + 3.0F / (8.0F * beta(valence)));
  };
  mesh->positions = moved(mesh->positions, rings_of(mesh->positions, *edges), limit, 1.0F / 5.0F);
  compute_smooth_normals(*mesh);
  // pbrt's normals of such meshes point to the side from which their triangles go clockwise.
  reverse(*mesh);
  return mesh;
}

}  // namespace hyades::core::pbrt
