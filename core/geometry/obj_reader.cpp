#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/chunks.h"
#include "core/geometry/mesh_source.h"
#include "core/geometry/obj_vertices.h"

namespace hyades::core {
namespace {

Result<ObjData> parse(std::span<const char> bytes) {
  auto parsed = parse_obj(bytes);
  // Any text is an OBJ file whose lines mean nothing.
  if (parsed && !bytes.empty() && parsed->positions.empty() && parsed->sizes.empty()) {
    return Error{kNoMesh};
  }
  return parsed;
}

/// A run of faces that have one material.
struct Part {
  std::string name;
  size_t first_face = 0;
  size_t faces = 0;
  size_t first_corner = 0;
  size_t corners = 0;
};

/// Sorts faces by their materials, in order of first use, those of one in the order of the file;
/// those before any are of kNoMaterial. Linear, however many there are.
std::vector<Part> sort_by_material(ObjData& data) {
  struct Run {
    size_t part, first_face, faces, first_corner, corners;
  };
  std::vector<Part> parts;
  std::vector<Run> runs;
  std::map<std::string, size_t> index;
  size_t corner = 0;
  const auto add_run = [&](const std::string& name, size_t begin, size_t end) {
    if (begin >= end) return;
    const auto [found, fresh] = index.emplace(name, parts.size());
    if (fresh) parts.push_back({name});
    const auto sizes = data.sizes.begin();
    const size_t corners = std::accumulate(sizes + static_cast<ptrdiff_t>(begin),
                                           sizes + static_cast<ptrdiff_t>(end), size_t{0});
    runs.push_back({found->second, begin, end - begin, corner, corners});
    parts[found->second].faces += end - begin;
    parts[found->second].corners += corners;
    corner += corners;
  };
  std::string name = kNoMaterial;
  size_t begin = 0;
  for (const ObjMaterial& material : data.materials) {
    add_run(name, begin, material.first);
    name = material.name;
    begin = material.first;
  }
  add_run(name, begin, data.sizes.size());
  for (size_t i = 1; i < parts.size(); ++i) {
    parts[i].first_face = parts[i - 1].first_face + parts[i - 1].faces;
    parts[i].first_corner = parts[i - 1].first_corner + parts[i - 1].corners;
  }
  if (runs.size() <= 1) return parts;
  std::vector<ObjCorner> corners(data.corners.size());
  std::vector<uint32_t> sizes(data.sizes.size());
  std::vector<std::pair<size_t, size_t>> next;  // by part: where the next run's faces, corners go
  for (const Part& part : parts) next.emplace_back(part.first_face, part.first_corner);
  for (const Run& run : runs) {
    std::copy_n(&data.sizes[run.first_face], run.faces, &sizes[next[run.part].first]);
    std::copy_n(&data.corners[run.first_corner], run.corners, &corners[next[run.part].second]);
    next[run.part].first += run.faces;
    next[run.part].second += run.corners;
  }
  data.corners = std::move(corners);
  data.sizes = std::move(sizes);
  return parts;
}

/// What the corners of one part say besides positions.
struct Said {
  bool uvs = false;
  bool normals = false;
};

Said said_by(std::span<const ObjCorner> corners) {
  const auto some = [&](int32_t ObjCorner::*index) {
    return std::any_of(corners.begin(), corners.end(),
                       [&](const ObjCorner& c) { return c.*index >= 0; });
  };
  return {some(&ObjCorner::vt), some(&ObjCorner::vn)};
}

/// Whether each position has the uv and the normal of its own number, as scans and many exporters
/// have it: then the file's lists are the mesh's.
bool is_numbered_alike(const ObjData& data, const Said& said) {
  std::atomic<bool> alike{true};
  for_chunks(data.corners.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && alike.load(std::memory_order_relaxed); ++i) {
      const ObjCorner& c = data.corners[i];
      const bool one = (!said.uvs || c.vt == c.v) && (!said.normals || c.vn == c.v);
      if (!one) alike.store(false, std::memory_order_relaxed);
    }
  });
  return alike.load();
}

/// Vertices without a colour among such that have one are white.
void complete_colors(std::vector<Vec4>& colors) {
  const auto is_none = [](const Vec4& color) { return color == kNoColor; };
  if (std::all_of(colors.begin(), colors.end(), is_none)) {
    colors.clear();
  } else {
    std::replace_if(colors.begin(), colors.end(), is_none, Vec4(1.0F));
  }
}

/// What is left when `mesh` has its vertices: `corners` and `sizes` of its polygons.
Result<std::shared_ptr<TriangleMesh>> with_faces(std::shared_ptr<TriangleMesh> mesh,
                                                 std::span<const uint32_t> corners,
                                                 std::span<const uint32_t> sizes) {
  complete_colors(mesh->colors);
  triangulate_all(mesh->positions, corners, sizes, mesh->triangles);
  if (Status s = complete_mesh(*mesh); !s) return s.error();
  return mesh;
}

/// The mesh of all faces of `data`, which is used up, where the lists are the mesh's.
Result<std::shared_ptr<TriangleMesh>> take_lists(ObjData& data, const Said& said) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = std::move(data.positions);
  mesh->colors = std::move(data.colors);
  if (said.uvs) mesh->uvs = std::move(data.uvs);
  if (said.normals) mesh->normals = std::move(data.normals);
  if (said.uvs) mesh->uvs.resize(mesh->positions.size(), Vec2(0.0F));
  if (said.normals) mesh->normals.resize(mesh->positions.size(), Vec3(0.0F));
  std::vector<uint32_t> corners(data.corners.size());
  for_chunks(corners.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) corners[i] = static_cast<uint32_t>(data.corners[i].v);
  });
  data.corners = {};
  return with_faces(std::move(mesh), corners, data.sizes);
}

/// The mesh of one part, whose vertices are those from `begin` to `end`.
Result<std::shared_ptr<TriangleMesh>> mesh_of(const ObjData& data, const Part& part,
                                              ObjVertices& vertices, size_t begin, size_t end) {
  const Said said = said_by(std::span(data.corners).subspan(part.first_corner, part.corners));
  auto mesh = std::make_shared<TriangleMesh>();
  const size_t count = end - begin;
  mesh->positions.reserve(count + 1);
  mesh->positions.resize(count);
  if (said.uvs) mesh->uvs.resize(count, Vec2(0.0F));
  if (said.normals) mesh->normals.resize(count, Vec3(0.0F));
  if (!data.colors.empty()) mesh->colors.resize(count);
  for_chunks(count, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const ObjCorner& c = data.corners[vertices.first[begin + i]];
      const auto v = static_cast<size_t>(c.v);
      mesh->positions[i] = data.positions[v];
      if (c.vt >= 0) mesh->uvs[i] = data.uvs[static_cast<size_t>(c.vt)];
      if (c.vn >= 0) mesh->normals[i] = data.normals[static_cast<size_t>(c.vn)];
      if (!data.colors.empty()) mesh->colors[i] = data.colors[v];
    }
  });
  const auto corners = std::span(vertices.of_corner).subspan(part.first_corner, part.corners);
  for_chunks(corners.size(), [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) corners[i] -= static_cast<uint32_t>(begin);
  });
  return with_faces(std::move(mesh), corners,
                    std::span(data.sizes).subspan(part.first_face, part.faces));
}

/// The meshes of all parts, in their order.
Result<std::vector<std::shared_ptr<TriangleMesh>>> meshes_of(ObjData& data,
                                                             const std::vector<Part>& parts) {
  using Mesh = Result<std::shared_ptr<TriangleMesh>>;
  std::vector<Mesh> made(parts.size(), Mesh(std::shared_ptr<TriangleMesh>()));
  const Said said = parts.size() == 1 ? said_by(data.corners) : Said();
  if (parts.size() == 1 && is_numbered_alike(data, said)) {
    made[0] = take_lists(data, said);
  } else {
    std::vector<size_t> ends;
    for (const Part& part : parts) ends.push_back(part.first_corner + part.corners);
    ObjVertices vertices = number_vertices(data.corners, data.positions.size(), ends);
    std::vector<size_t> begins;
    for (const Part& part : parts) begins.push_back(vertices.of_corner[part.first_corner]);
    begins.push_back(vertices.first.size());
    const Status all = parallel_for(parts.size(), 0, [&](size_t i) {
      made[i] = mesh_of(data, parts[i], vertices, begins[i], begins[i + 1]);
    });
    if (!all) return all.error();
  }
  std::vector<std::shared_ptr<TriangleMesh>> meshes;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!made[i]) {
      const Error& why = made[i].error();
      return parts.size() > 1 ? why.in("material '" + parts[i].name + "'") : why;
    }
    meshes.push_back(std::move(*made[i]));
  }
  return meshes;
}

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_obj(std::span<const char> bytes) {
  auto data = parse(bytes);
  if (!data) return data.error();
  data->materials.clear();
  auto meshes = meshes_of(*data, {{kNoMaterial, 0, data->sizes.size(), 0, data->corners.size()}});
  if (!meshes) return meshes.error();
  return meshes->front();
}

Result<MeshParts> read_obj_parts(std::span<const char> bytes) {
  auto data = parse(bytes);
  if (!data) return data.error();
  const std::vector<Part> parts = sort_by_material(*data);
  auto meshes = meshes_of(*data, parts);
  if (!meshes) return meshes.error();
  MeshParts result;
  result.libraries = std::move(data->libraries);
  result.left_out = data->left_out;
  for (size_t i = 0; i < parts.size(); ++i) {
    result.parts.push_back({parts[i].name, (*meshes)[i]});
  }
  return result;
}

}  // namespace hyades::core
