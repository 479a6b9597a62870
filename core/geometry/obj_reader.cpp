#include <algorithm>
#include <utility>

#include "core/geometry/mesh_source.h"
#include "core/geometry/obj_parser.h"

namespace hyades::core {
namespace {

constexpr uint32_t kNone = 0xFFFFFFFFU;

/// One vertex per distinct (v, vt, vn). The vertices of a position form a chain, found without
/// hashing: most positions have one or two.
class VertexSplitter {
 public:
  VertexSplitter(const ObjData& data, TriangleMesh& mesh)
      : data_(data), mesh_(mesh), first_(data.positions.size(), kNone) {}

  uint32_t vertex(const ObjCorner& c) {
    uint32_t at = first_[static_cast<size_t>(c.v)];
    while (at != kNone && (keys_[at].vt != c.vt || keys_[at].vn != c.vn)) at = keys_[at].next;
    if (at != kNone) return at;
    const auto fresh = static_cast<uint32_t>(keys_.size());
    keys_.push_back({c.vt, c.vn, std::exchange(first_[static_cast<size_t>(c.v)], fresh)});
    mesh_.positions.push_back(data_.positions[static_cast<size_t>(c.v)]);
    if (!data_.uvs.empty()) {
      mesh_.uvs.push_back(c.vt < 0 ? Vec2(0.0F) : data_.uvs[static_cast<size_t>(c.vt)]);
    }
    if (!data_.normals.empty()) {
      mesh_.normals.push_back(c.vn < 0 ? Vec3(0.0F) : data_.normals[static_cast<size_t>(c.vn)]);
    }
    return fresh;
  }

 private:
  struct Key {
    int32_t vt;
    int32_t vn;
    uint32_t next;
  };
  const ObjData& data_;
  TriangleMesh& mesh_;
  std::vector<uint32_t> first_;
  std::vector<Key> keys_;
};

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_obj(std::span<const char> bytes) {
  auto parsed = parse_obj(bytes);
  if (!parsed) return parsed.error();
  ObjData& data = *parsed;
  // Any text is an OBJ file whose lines mean nothing.
  if (!bytes.empty() && data.positions.empty() && data.sizes.empty()) return Error{kNoMesh};
  const auto uses = [&](int32_t ObjCorner::*index) {
    return std::any_of(data.corners.begin(), data.corners.end(),
                       [&](const ObjCorner& c) { return c.*index >= 0; });
  };
  if (!uses(&ObjCorner::vt)) data.uvs.clear();
  if (!uses(&ObjCorner::vn)) data.normals.clear();

  auto mesh = std::make_shared<TriangleMesh>();
  std::vector<uint32_t> corners;
  corners.reserve(data.corners.size());
  if (data.uvs.empty() && data.normals.empty()) {
    mesh->positions = std::move(data.positions);
    for (const ObjCorner& c : data.corners) corners.push_back(static_cast<uint32_t>(c.v));
  } else {
    mesh->positions.reserve(data.positions.size() + 1);
    VertexSplitter splitter(data, *mesh);
    for (const ObjCorner& c : data.corners) corners.push_back(splitter.vertex(c));
  }
  mesh->triangles.reserve(data.sizes.size());
  size_t at = 0;
  for (const uint32_t size : data.sizes) {
    triangulate(mesh->positions, std::span(corners).subspan(at, size), mesh->triangles);
    at += size;
  }
  if (Status s = complete_mesh(*mesh); !s) return s.error();
  return mesh;
}

}  // namespace hyades::core
