#include "core/geometry/displace.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/chunks.h"
#include "core/geometry/tessellate.h"
#include "core/geometry/weld.h"

namespace hyades::core {
namespace {

std::vector<float> heights_of(const TriangleMesh& mesh, const HeightField& height) {
  std::vector<float> heights(mesh.positions.size());
  for_chunks(heights.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Vec2 uv = mesh.uvs.empty() ? Vec2(0.0F) : mesh.uvs[i];
      heights[i] = height(uv, mesh.positions[i]);
    }
  });
  return heights;
}

/// Vertices of one place get the mean of their heights.
void share_heights(const std::vector<uint32_t>& place, std::vector<float>& heights) {
  std::vector<double> sums(heights.size(), 0.0);
  std::vector<uint32_t> counts(heights.size(), 0);
  for (size_t i = 0; i < heights.size(); ++i) {
    sums[place[i]] += double{heights[i]};
    ++counts[place[i]];
  }
  for (size_t i = 0; i < heights.size(); ++i)
    heights[i] = static_cast<float>(sums[place[i]] / counts[place[i]]);
}

Status move_all(TriangleMesh& mesh, const std::vector<Vec3>& along, const HeightField& height) {
  const std::vector<uint32_t> place = weld(mesh.positions);
  std::vector<float> heights = heights_of(mesh, height);
  share_heights(place, heights);
  for (size_t i = 0; i < heights.size(); ++i) {
    const Vec3 was = mesh.positions[i];
    const Vec3 is(Vec3d(was) + Vec3d(along[place[i]]) * double{heights[i]});
    if (!std::isfinite(is.x) || !std::isfinite(is.y) || !std::isfinite(is.z)) {
      return Error{
          fmt::format("its height at [{:.6g}, {:.6g}, {:.6g}] is {}, expected a number that "
                      "leaves places finite",
                      was.x, was.y, was.z, heights[i])};
    }
    mesh.positions[i] = is;
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<TriangleMesh>> displace(const TriangleMesh& base, const Displacement& how,
                                               const HeightField& height) {
  auto mesh = std::make_shared<TriangleMesh>(base);
  const bool creased = how.normals == DisplacedNormals::creased && !mesh->normals.empty();
  if (!creased) mesh->normals.clear();
  std::vector<Vec3> along = smooth_normals(*mesh, weld(mesh->positions));
  if (auto done = tessellate(*mesh, along, how.max_edge, how.budget); !done) return done.error();
  // Before anything moves: what is one place stays one, and different places may come together.
  std::vector<uint32_t> shading;
  if (creased) shading = weld(mesh->positions, mesh->normals);
  if (how.normals != DisplacedNormals::flat && !creased) shading = weld(mesh->positions);
  if (auto done = move_all(*mesh, along, height); !done) return done.error();
  if (!shading.empty()) mesh->normals = smooth_normals(*mesh, shading);
  finish_mesh(*mesh);
  return mesh;
}

}  // namespace hyades::core
