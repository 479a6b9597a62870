#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "import/gltf/read_model.h"

namespace hyades::core {

namespace {

/// How many there are of what nodes refer to by JSON.
struct Counts {
  size_t cameras = 0;
  size_t lights = 0;
};

GltfNode read_node(const JsonValue& value, const GltfModel& model, const Counts& counts,
                   std::set<std::string>& notes) {
  GltfNode node;
  node.name = value.text("name");
  for (const JsonValue& child : value.list("children")) {
    node.children.push_back(child.as_index(model.nodes.size()));
  }
  node.mesh = value.index("mesh", model.meshes.size());
  node.skin = value.index("skin", model.skins.size());
  node.camera = value.index("camera", counts.cameras);
  node.weights = value.numbers("weights");
  std::array<float, 16> numbers{};
  if (value.numbers("matrix", numbers)) {
    Mat4 matrix(1.0F);
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<size_t>(i)];
    matrix[0][3] = matrix[1][3] = matrix[2][3] = 0.0F;
    matrix[3][3] = 1.0F;
    node.matrix = matrix;
  }
  value.numbers("translation", std::span(&node.place.translation.x, 3));
  value.numbers("rotation", std::span(&node.place.rotation.x, 4));
  value.numbers("scale", std::span(&node.place.scale.x, 3));
  const float length = glm::length(node.place.rotation);
  if (length < 1e-6F) {
    value.complain("has a rotation of length 0");
  } else {
    node.place.rotation /= length;
  }
  const JsonValue extensions = value.member("extensions");
  node.light = extensions.member("KHR_lights_punctual").index("light", counts.lights);
  const JsonValue instancing = extensions.member("EXT_mesh_gpu_instancing").member("attributes");
  for (const std::string& key : instancing.keys()) {
    if (key != "TRANSLATION" && key != "ROTATION" && key != "SCALE") {
      notes.insert("instances of nodes have " + key + ", which is left out");
      continue;
    }
    node.instances[key] = instancing.required_index(key, model.accessors.size());
  }
  return node;
}

/// Nodes may lie this deep below each other. Skeletons have some dozens.
constexpr int kMaxNodeDepth = 1024;

/// Parents; error where a node has several, or is its own.
Status link_parents(std::vector<GltfNode>& nodes) {
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (child < 0) continue;
      GltfNode& below = nodes[static_cast<size_t>(child)];
      if (below.parent >= 0) {
        return Error{fmt::format("nodes[{}] is a child of both nodes[{}] and nodes[{}]", child,
                                 below.parent, i)};
      }
      below.parent = static_cast<int>(i);
    }
  }
  // Each has one parent at most now, so that a cycle is a way up that never ends.
  std::vector<uint8_t> known(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i) {
    std::vector<size_t> way;
    int at = static_cast<int>(i);
    while (at >= 0 && known[static_cast<size_t>(at)] == 0) {
      known[static_cast<size_t>(at)] = 1;
      way.push_back(static_cast<size_t>(at));
      at = nodes[static_cast<size_t>(at)].parent;
    }
    if (at >= 0 && known[static_cast<size_t>(at)] == 1) {
      return Error{fmt::format("nodes[{}] is its own descendant", at)};
    }
    for (const size_t done : way) known[done] = 2;
  }
  return {};
}

}  // namespace

Status read_nodes(const JsonValue& root, GltfModel& model) {
  const std::vector<JsonValue> values = root.list("nodes");
  model.nodes.resize(values.size());
  const Counts counts{
      root.list("cameras").size(),
      root.member("extensions").member("KHR_lights_punctual").list("lights").size()};
  std::set<std::string> notes;
  for (size_t i = 0; i < values.size(); ++i) {
    model.nodes[i] = read_node(values[i], model, counts, notes);
  }
  model.notes.insert(model.notes.end(), notes.begin(), notes.end());
  if (Status s = link_parents(model.nodes); !s) return s;
  const std::vector<JsonValue> scenes = root.list("scenes");
  std::vector<int> waiting;
  if (scenes.empty()) {
    for (size_t i = model.nodes.size(); i-- > 0;) {
      if (model.nodes[i].parent < 0) waiting.push_back(static_cast<int>(i));
    }
  } else {
    const int scene = std::max(root.index("scene", scenes.size()), 0);
    if (scenes.size() > 1) {
      model.notes.push_back(fmt::format("only scenes[{}] of {} is shown", scene, scenes.size()));
    }
    const std::vector<JsonValue> roots = scenes[static_cast<size_t>(scene)].list("nodes");
    for (size_t i = roots.size(); i-- > 0;) {
      const int node = roots[i].as_index(model.nodes.size());
      if (node >= 0) waiting.push_back(node);
    }
  }
  std::vector<int> depths(model.nodes.size(), 0);
  std::vector<uint8_t> reached(model.nodes.size(), 0);
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    if (reached[static_cast<size_t>(at)]++ != 0) {
      return Error{fmt::format("nodes[{}] is in the scene twice", at)};
    }
    model.order.push_back(at);
    const int depth = depths[static_cast<size_t>(at)];
    if (depth > kMaxNodeDepth) {
      return Error{fmt::format("nodes[{}] lies more than {} nodes deep", at, kMaxNodeDepth)};
    }
    const std::vector<int>& children = model.nodes[static_cast<size_t>(at)].children;
    for (size_t i = children.size(); i-- > 0;) {
      if (children[i] < 0) continue;
      depths[static_cast<size_t>(children[i])] = depth + 1;
      waiting.push_back(children[i]);
    }
  }
  return {};
}

}  // namespace hyades::core
