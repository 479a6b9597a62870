#include "core/import/gltf/ply_writer.h"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <vector>

namespace hyades::core {

namespace {

/// Some numbers of every vertex, as floats one after the other.
struct Column {
  const float* from;
  size_t width;
  std::vector<const char*> names;
};

std::vector<Column> columns_of(const GltfGeometry& g) {
  std::vector<Column> columns = {{&g.positions[0].x, 3, {"x", "y", "z"}}};
  if (!g.normals.empty()) columns.push_back({&g.normals[0].x, 3, {"nx", "ny", "nz"}});
  if (!g.uvs[0].empty()) columns.push_back({&g.uvs[0][0].x, 2, {"u", "v"}});
  if (!g.uvs[1].empty()) columns.push_back({&g.uvs[1][0].x, 2, {"u1", "v1"}});
  if (!g.colors.empty()) {
    columns.push_back({&g.colors[0].x, 4, {"red", "green", "blue", "alpha"}});
  }
  // Of facets the file's tangents mean nothing.
  if (!g.tangents.empty() && !g.normals.empty()) {
    columns.push_back({&g.tangents[0].x, 4, {"tx", "ty", "tz", "tw"}});
  }
  return columns;
}

}  // namespace

Bytes write_ply(const GltfGeometry& g) {
  std::string header =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", g.positions.size());
  const std::vector<Column> columns = columns_of(g);
  size_t row = 0;
  for (const Column& column : columns) {
    row += column.width * sizeof(float);
    for (const char* name : column.names) header += fmt::format("property float {}\n", name);
  }
  header += fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                        g.triangles.size());
  auto out = std::make_shared<std::vector<std::byte>>(header.size() + g.positions.size() * row +
                                                      g.triangles.size() * 13);
  std::byte* at = out->data();
  std::memcpy(at, header.data(), header.size());
  at += header.size();
  size_t offset = 0;
  for (const Column& column : columns) {
    const bool uv = column.width == 2;
    for (size_t i = 0; i < g.positions.size(); ++i) {
      std::byte* to = at + i * row + offset;
      const float* from = column.from + i * column.width;
      if (uv) {
        const float turned[2] = {from[0], 1.0F - from[1]};
        std::memcpy(to, turned, sizeof turned);
      } else {
        std::memcpy(to, from, column.width * sizeof(float));
      }
    }
    offset += column.width * sizeof(float);
  }
  at += g.positions.size() * row;
  for (const std::array<uint32_t, 3>& triangle : g.triangles) {
    *at++ = std::byte{3};
    std::memcpy(at, triangle.data(), 12);
    at += 12;
  }
  return {out, *out};
}

}  // namespace hyades::core
