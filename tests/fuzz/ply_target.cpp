// A PLY mesh, of text and of both orders of bytes.

#include "core/geometry/mesh.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/write_ply.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  const std::string head = "property float x\nproperty float y\nproperty float z\n";
  std::vector<std::string> all{
      "ply\nformat ascii 1.0\ncomment a quad\nelement vertex 4\n" + head +
          "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
          "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n"
          "1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n",
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\n" + head +
          "element face 1\nproperty list uchar uint vertex_indices\nproperty uchar flag\n"
          "end_header\n" +
          std::string(36, '\0') + std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2\7", 14)};
  core::TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const core::Bytes bytes = core::ply_bytes(mesh);
  all.emplace_back(bytes.chars(), bytes.size());
  return all;
}

bool try_input(std::string_view input) {
  Files files("a.ply", input);
  return core::read_mesh(files, "a.ply").ok();
}

}  // namespace hyades::fuzz
