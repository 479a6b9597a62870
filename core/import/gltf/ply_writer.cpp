#include "core/import/gltf/ply_writer.h"

#include <fmt/format.h>

#include <cstring>

namespace hyades::core {

namespace {

std::string header_of(const GltfGeometry& g) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      g.positions.size());
  if (!g.normals.empty()) {
    header += "property float nx\nproperty float ny\nproperty float nz\n";
  }
  if (!g.uvs[0].empty()) header += "property float u\nproperty float v\n";
  header += fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                        g.triangles.size());
  return header;
}

}  // namespace

Bytes write_ply(const GltfGeometry& g) {
  const std::string header = header_of(g);
  const size_t floats = 3 + (g.normals.empty() ? 0 : 3) + (g.uvs[0].empty() ? 0 : 2);
  const size_t row = floats * sizeof(float);
  auto out = std::make_shared<std::vector<std::byte>>(header.size() + g.positions.size() * row +
                                                      g.triangles.size() * 13);
  std::byte* at = out->data();
  std::memcpy(at, header.data(), header.size());
  at += header.size();
  for (size_t i = 0; i < g.positions.size(); ++i) {
    std::memcpy(at, &g.positions[i].x, 12);
    at += 12;
    if (!g.normals.empty()) {
      std::memcpy(at, &g.normals[i].x, 12);
      at += 12;
    }
    if (!g.uvs[0].empty()) {
      const Vec2 uv(g.uvs[0][i].x, 1.0F - g.uvs[0][i].y);
      std::memcpy(at, &uv.x, 8);
      at += 8;
    }
  }
  for (const std::array<uint32_t, 3>& triangle : g.triangles) {
    *at++ = std::byte{3};
    std::memcpy(at, triangle.data(), 12);
    at += 12;
  }
  return {out, *out};
}

}  // namespace hyades::core
