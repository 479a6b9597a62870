#include "core/import/gltf/instancing.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/read_places.h"
#include "core/import/gltf/accessor.h"
#include "core/import/gltf/animation.h"
#include "core/import/gltf/motion.h"
#include "core/import/mass_copies.h"
#include "core/import/names.h"

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

GltfPlaceFiles::GltfPlaceFiles(std::shared_ptr<const GltfModel> model) : model_(std::move(model)) {
  Names names("copies");
  for (const int node : model_->order) {
    const GltfNode& at = model_->nodes[static_cast<size_t>(node)];
    if (at.mesh < 0 || at.instances.empty()) continue;
    const std::string& mesh = model_->meshes[static_cast<size_t>(at.mesh)].name;
    const std::string base = safe_name(at.name.empty() ? mesh : at.name, "copies");
    names_[node] = "places/" + names.add(base) + ".ply";
  }
}

Result<Bytes> GltfPlaceFiles::made(const std::string& name) const {
  for (const auto& [node, file] : names_) {
    if (file != name) continue;
    const auto copies = copies_of(*model_, node);
    if (!copies) return copies.error();
    return places_bytes(copies->in_file);
  }
  return model_->error("it has no part '" + name + "'");
}

}  // namespace hyades::core
