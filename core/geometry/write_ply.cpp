#include "core/geometry/write_ply.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/chunks.h"

namespace hyades::core {
namespace {

static_assert(std::endian::native == std::endian::little);

/// One of the vectors of a mesh, as floats of the file's rows.
struct Attribute {
  const std::byte* values;
  size_t bytes;   ///< of one vertex
  size_t offset;  ///< in a row
};

/// What a file's header says, and how its rows are put together.
class Layout {
 public:
  explicit Layout(const TriangleMesh& mesh) {
    header_ = "ply\nformat binary_little_endian 1.0\nelement vertex " +
              std::to_string(mesh.positions.size()) + "\n";
    add(mesh.positions, {"x", "y", "z"});
    add(mesh.normals, {"nx", "ny", "nz"});
    add(mesh.uvs, {"u", "v"});
    add(mesh.second_uvs, {"u1", "v1"});
    add(mesh.colors, {"red", "green", "blue", "alpha"});
    add(mesh.vertex_tangents, {"tx", "ty", "tz", "tw"});
    header_ += "element face " + std::to_string(mesh.triangles.size()) +
               "\nproperty list uchar uint vertex_indices\nend_header\n";
  }

  const std::string& header() const { return header_; }
  const std::vector<Attribute>& attributes() const { return attributes_; }
  size_t row() const { return row_; }

 private:
  template <class Vec, size_t N>
  void add(const std::vector<Vec>& values, const char* const (&names)[N]) {
    static_assert(sizeof(Vec) == N * sizeof(float));
    if (values.empty()) return;
    for (const char* name : names) header_ += std::string("property float ") + name + "\n";
    attributes_.push_back({reinterpret_cast<const std::byte*>(values.data()), sizeof(Vec), row_});
    row_ += sizeof(Vec);
  }

  std::string header_;
  std::vector<Attribute> attributes_;
  size_t row_ = 0;
};

}  // namespace

Bytes ply_bytes(const TriangleMesh& mesh) {
  constexpr size_t kFaceRow = 1 + 3 * sizeof(uint32_t);
  const Layout layout(mesh);
  const size_t vertices = mesh.positions.size();
  const size_t size =
      layout.header().size() + vertices * layout.row() + mesh.triangles.size() * kFaceRow;
  const std::shared_ptr<std::byte[]> out(new std::byte[size]);
  std::memcpy(out.get(), layout.header().data(), layout.header().size());
  std::byte* rows = out.get() + layout.header().size();
  for_chunks(vertices, [&](size_t begin, size_t end) {
    for (const Attribute& attribute : layout.attributes()) {
      for (size_t i = begin; i < end; ++i) {
        std::memcpy(rows + i * layout.row() + attribute.offset,
                    attribute.values + i * attribute.bytes, attribute.bytes);
      }
    }
  });
  std::byte* faces = rows + vertices * layout.row();
  for_chunks(mesh.triangles.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      faces[i * kFaceRow] = std::byte{3};
      std::memcpy(faces + i * kFaceRow + 1, mesh.triangles[i].data(), 3 * sizeof(uint32_t));
    }
  });
  return {out, {out.get(), size}};
}

}  // namespace hyades::core
