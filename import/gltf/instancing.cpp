#include "import/gltf/instancing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "core/geometry/read_places.h"
#include "import/gltf/accessor.h"
#include "import/gltf/animation.h"
#include "import/gltf/motion.h"
#include "import/mass_copies.h"
#include "import/names.h"

namespace hyades::core {

namespace {

Result<std::vector<GltfPlace>> read_places(const GltfModel& model,
                                           const GltfAttributes& attributes) {
  std::vector<GltfPlace> places;
  bool counted = false;
  const auto read = [&](const char* name, size_t width, auto&& set) -> Status {
    const auto at = attributes.find(name);
    if (at == attributes.end()) return {};
    const auto numbers = read_floats(model, at->second, width);
    if (!numbers) return numbers.error();
    const size_t count = numbers->size() / width;
    if (counted && count != places.size()) {
      return model.error(fmt::format("{} has {} instances, but another attribute has {}",
                                     model.accessors[static_cast<size_t>(at->second)].place, count,
                                     places.size()));
    }
    counted = true;
    places.resize(count);
    for (size_t i = 0; i < count; ++i) set(places[i], numbers->data() + width * i);
    return {};
  };
  for (const Status& s : {read("TRANSLATION", 3,
                               [](GltfPlace&p, const float*n) {
                                 p.translation = {n[0], n[1], n[2]};
                               }),
                          read("ROTATION", 4,
                               [](GltfPlace&p, const float*n) {
                                 const Vec4 q(n[0], n[1], n[2], n[3]);
                                 const float length = glm::length(q);
                                 if (length > 0.0F) p.rotation = q / length;
                               }),
                          read("SCALE", 3, [](GltfPlace&p, const float*n) {
                            p.scale = {n[0], n[1], n[2]};
                          })}) {
    if (!s) return s.error();
  }
  return places;
}

bool has_targets(const GltfMesh& mesh) {
  return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                     [](const GltfPrimitive& primitive) { return !primitive.targets.empty(); });
}

}  // namespace

size_t count_copies(const GltfModel& model, const GltfNode& node) {
  size_t count = 0;
  for (const auto& [name, accessor] : node.instances) {
    count = std::max(count, model.accessors[static_cast<size_t>(accessor)].count);
  }
  return count;
}

Result<GltfCopies> copies_of(const GltfModel& model, int node) {
  const GltfNode& at = model.nodes[static_cast<size_t>(node)];
  const auto places = read_places(model, at.instances);
  if (!places) return places.error();
  // At rest, whatever is animated, so that the file is the same for all animations.
  const Mat4 world = at.skin >= 0 ? Mat4(1.0F) : world_matrix(model, nullptr, node, 0.0);
  GltfCopies out;
  const bool many = places->size() >= kFewestCopies;
  (many ? out.in_file : out.single).reserve(places->size());
  for (const GltfPlace& place : *places) {
    const Mat4 matrix = matrix_of(place);
    if (place.scale == Vec3(0.0F)) {
      ++out.vanished;
    } else {
      const bool in_file = many && can_be_copied(world * matrix);
      (in_file ? out.in_file : out.single).emplace_back(matrix);
    }
  }
  return out;
}

GltfPlaceFiles::GltfPlaceFiles(std::shared_ptr<const GltfModel> model, const GltfMeshFiles& files)
    : model_(std::move(model)), files_(files) {
  Names names("copies");
  for (const int node : model_->order) {
    const GltfNode& at = model_->nodes[static_cast<size_t>(node)];
    if (at.mesh < 0) continue;
    const GltfMesh& mesh = model_->meshes[static_cast<size_t>(at.mesh)];
    if (!at.instances.empty()) {
      names_[node] = names.add(safe_name(at.name.empty() ? mesh.name : at.name, "copies"));
    } else if (at.skin < 0 && !has_targets(mesh)) {
      nodes_[at.mesh].push_back(node);
    }
  }
  std::erase_if(nodes_, [](const auto& entry) { return entry.second.size() < kFewestNodes; });
  for (const auto& [mesh, nodes] : nodes_) {
    const std::string& own = model_->meshes[static_cast<size_t>(mesh)].name;
    const std::string& first = model_->nodes[static_cast<size_t>(nodes.front())].name;
    shared_names_[mesh] = names.add(safe_name(own.empty() ? first : own, "copies"));
  }
}

std::vector<int> GltfPlaceFiles::shared_meshes() const {
  std::vector<int> meshes;
  for (const auto& [mesh, nodes] : nodes_) meshes.push_back(mesh);
  return meshes;
}

GltfSharedMesh GltfPlaceFiles::shared(int mesh, const GltfClip* clip) const {
  GltfSharedMesh out;
  for (const int node : nodes_.at(mesh)) {
    if (moves_in_scene(clip, node)) continue;
    const Mat4 world = world_matrix(*model_, clip, node, 0.0);
    if (!can_be_copied(world)) continue;
    out.places.emplace_back(world);
    out.nodes.push_back(node);
  }
  return out.nodes.size() >= kFewestNodes ? out : GltfSharedMesh();
}

std::string GltfPlaceFiles::shared_name(int mesh, const GltfClip* clip, size_t animation) const {
  const std::string folder = clip != nullptr ? files_.clip_name(animation) + "/" : "";
  return "places/" + folder + shared_names_.at(mesh) + ".ply";
}

Result<Bytes> GltfPlaceFiles::made(const std::string& name) const {
  const Error unknown = model_->error("it has no part '" + name + "'");
  std::string_view rest = name;
  if (!rest.starts_with("places/") || !rest.ends_with(".ply")) return unknown;
  rest = rest.substr(7, rest.size() - 11);
  std::shared_ptr<const GltfClip> clip;
  const size_t slash = rest.find('/');
  if (slash != std::string_view::npos) {
    const auto index = files_.clip_in_folder(rest.substr(0, slash));
    if (!index) return unknown;
    auto read = files_.clip(*index);
    if (!read) return read.error();
    clip = *read;
    rest = rest.substr(slash + 1);
  }
  for (const auto& [mesh, own] : shared_names_) {
    if (own == rest) return places_bytes(shared(mesh, clip.get()).places);
  }
  for (const auto& [node, own] : names_) {
    if (own != rest || clip != nullptr) continue;
    const auto copies = copies_of(*model_, node);
    if (!copies) return copies.error();
    return places_bytes(copies->in_file);
  }
  return unknown;
}

}  // namespace hyades::core
