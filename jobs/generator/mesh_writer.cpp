#include "jobs/generator/mesh_writer.h"

#include <cstdio>
#include <cstring>

namespace hyades::gallery {
namespace {

template <class T>
void append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

bool write_ply(const std::string& path, const Mesh& mesh, const std::string& comment) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment " + comment +
                    "\nelement vertex " + std::to_string(mesh.positions.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) out += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) out += "property float u\nproperty float v\n";
  out += "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append(out, mesh.positions[i]);
    if (!mesh.normals.empty()) append(out, mesh.normals[i]);
    if (!mesh.uvs.empty()) append(out, mesh.uvs[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    out.push_back(3);
    append(out, triangle);
  }
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool written =
      file != nullptr && std::fwrite(out.data(), 1, out.size(), file) == out.size();
  if (file == nullptr || std::fclose(file) != 0 || !written) {
    std::fprintf(stderr, "%s: could not be written\n", path.c_str());
    return false;
  }
  return true;
}

}  // namespace hyades::gallery
