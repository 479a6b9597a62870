#include "core/geometry/write_ply.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <memory>
#include <string>

namespace hyades::core {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr size_t kFaceBytes = 1 + 3 * sizeof(uint32_t);

std::string header_of(const TriangleMesh& mesh) {
  std::string text = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
                                 mesh.positions.size());
  const auto properties = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) text += fmt::format("property float {}\n", name);
  };
  properties({"x", "y", "z"});
  if (!mesh.normals.empty()) properties({"nx", "ny", "nz"});
  if (!mesh.uvs.empty()) properties({"u", "v"});
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                      mesh.triangles.size());
  return text;
}

}  // namespace

Bytes ply_bytes(const TriangleMesh& mesh) {
  const std::string header = header_of(mesh);
  const size_t floats = 3 + (mesh.normals.empty() ? 0 : 3) + (mesh.uvs.empty() ? 0 : 2);
  const size_t size = header.size() + mesh.positions.size() * floats * sizeof(float) +
                      mesh.triangles.size() * kFaceBytes;
  std::shared_ptr<char[]> bytes(new char[size]);
  char* at = bytes.get();
  const auto put = [&](const void* from, size_t count) {
    std::memcpy(at, from, count);
    at += count;
  };
  put(header.data(), header.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    put(&mesh.positions[i], sizeof(Vec3));
    if (!mesh.normals.empty()) put(&mesh.normals[i], sizeof(Vec3));
    if (!mesh.uvs.empty()) put(&mesh.uvs[i], sizeof(Vec2));
  }
  for (const auto& triangle : mesh.triangles) {
    *at++ = 3;
    put(triangle.data(), sizeof(triangle));
  }
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.get());
  return {std::shared_ptr<const void>(bytes, bytes.get()), {begin, size}};
}

}  // namespace hyades::core
