#include "import/gltf/left_out.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <set>

namespace hyades::core {

namespace {

/// Where something is that is left out.
struct Found {
  std::string first;  ///< place
  size_t more = 0;
};

bool is_known_attribute(const std::string& name) {
  static const std::set<std::string> kKnown = {"POSITION",   "NORMAL",     "TANGENT",
                                               "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
  // All sets of bones count.
  return kKnown.contains(name) || name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

bool is_known_of_targets(const std::string& name) {
  return name == "POSITION" || name == "NORMAL" || name == "TANGENT";
}

void tell(const std::map<std::string, Found>& found, const char* what,
          std::vector<std::string>& notes) {
  for (const auto& [name, at] : found) {
    const std::string more = at.more > 0 ? fmt::format(" and {} more", at.more) : "";
    notes.push_back(fmt::format("{}{} of {}{} is left out", name, what, at.first, more));
  }
}

}  // namespace

std::vector<std::string> left_out_attributes(const GltfModel& model) {
  std::map<std::string, Found> of_vertices;
  std::map<std::string, Found> of_targets;
  const auto add = [](std::map<std::string, Found>& found, const std::string& name,
                      const std::string& place) {
    const auto [at, is_new] = found.try_emplace(name, Found{place, 0});
    if (!is_new) ++at->second.more;
  };
  for (const GltfMesh& mesh : model.meshes) {
    for (const GltfPrimitive& primitive : mesh.primitives) {
      for (const auto& [name, accessor] : primitive.attributes) {
        if (!is_known_attribute(name)) add(of_vertices, name, primitive.place);
      }
      std::set<std::string> morphed;
      for (const GltfAttributes& target : primitive.targets) {
        for (const auto& [name, accessor] : target) {
          if (!is_known_of_targets(name)) morphed.insert(name);
        }
      }
      for (const std::string& name : morphed) add(of_targets, name, primitive.place);
    }
  }
  std::vector<std::string> notes;
  tell(of_vertices, "", notes);
  tell(of_targets, " in the morph targets", notes);
  return notes;
}

}  // namespace hyades::core
