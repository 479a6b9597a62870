#include <algorithm>
#include <map>
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

/// A face's run in the list of corners.
struct ObjCorners {
  size_t first;
  uint32_t size;
};

Result<ObjData> parse(std::span<const char> bytes) {
  auto parsed = parse_obj(bytes);
  // Any text is an OBJ file whose lines mean nothing.
  if (parsed && !bytes.empty() && parsed->positions.empty() && parsed->sizes.empty()) {
    return Error{kNoMesh};
  }
  return parsed;
}

/// A mesh of all faces of `data`, which is used up.
Result<std::shared_ptr<TriangleMesh>> make_mesh(ObjData& data) {
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

/// The faces of each material, in order of their first use; those before any are of kNoMaterial.
std::vector<std::pair<std::string, std::vector<ObjCorners>>> faces_by_material(
    const ObjData& data) {
  std::vector<std::pair<std::string, std::vector<ObjCorners>>> parts;
  std::map<std::string, size_t> index;
  size_t corner = 0;
  size_t next = 0;
  std::string name = kNoMaterial;
  for (size_t face = 0; face < data.sizes.size(); ++face) {
    while (next < data.materials.size() && data.materials[next].first <= face) {
      name = data.materials[next++].name;
    }
    const auto [found, fresh] = index.emplace(name, parts.size());
    if (fresh) parts.emplace_back(name, std::vector<ObjCorners>());
    parts[found->second].second.push_back({corner, data.sizes[face]});
    corner += data.sizes[face];
  }
  return parts;
}

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_obj(std::span<const char> bytes) {
  auto data = parse(bytes);
  if (!data) return data.error();
  return make_mesh(*data);
}

Result<MeshParts> read_obj_parts(std::span<const char> bytes) {
  auto data = parse(bytes);
  if (!data) return data.error();
  MeshParts result;
  result.libraries = data->libraries;
  for (const auto& [name, faces] : faces_by_material(*data)) {
    ObjData part;
    part.positions = data->positions;
    part.uvs = data->uvs;
    part.normals = data->normals;
    for (const ObjCorners& face : faces) {
      const auto from = data->corners.begin() + static_cast<ptrdiff_t>(face.first);
      part.corners.insert(part.corners.end(), from, from + face.size);
      part.sizes.push_back(face.size);
    }
    auto mesh = make_mesh(part);
    if (!mesh) return mesh.error().in("material '" + name + "'");
    result.parts.push_back({name, *mesh});
  }
  return result;
}

}  // namespace hyades::core
