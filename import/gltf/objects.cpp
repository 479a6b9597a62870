#include "import/gltf/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "core/geometry/placed_object.h"
#include "import/gltf/geometry.h"
#include "import/mass_copies.h"

namespace hyades::core {

namespace {

constexpr const char* kModes[] = {"points", "lines", "line loops", "line strips"};

/// Whether what hangs on a node has no size, or is turned inside out, at some time of a clip.
bool may_vanish(const GltfModel& model, const GltfClip* clip, int node) {
  constexpr float kLeast = 1e-3F;
  for (int at = node; clip != nullptr && at >= 0;
       at = model.nodes[static_cast<size_t>(at)].parent) {
    const GltfTrack* sizes = clip->track(at, GltfChannel::Path::scale);
    if (sizes == nullptr) continue;
    for (size_t i = 0; i < sizes->times.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        const float size = sizes->key(i)[k];
        if (!(std::abs(size) > kLeast) || size * sizes->key(0)[k] < 0.0F) return true;
      }
    }
  }
  return false;
}

class ObjectWriter {
 public:
  ObjectWriter(const GltfStage& stage, GltfMaterials& materials)
      : stage_(stage),
        materials_(materials),
        names_("object", stage.request.prefix),
        group_names_("copies", stage.request.prefix) {}

  /// Nodes that stand still and show the same mesh, where they are very many.
  Status shared_meshes() {
    told_.assign(stage_.model.nodes.size(), 0);
    for (const int mesh : stage_.places.shared_meshes()) {
      const GltfSharedMesh shared = stage_.places.shared(mesh, stage_.clip);
      if (shared.nodes.empty()) continue;
      std::vector<Part> parts = parts_of(shared.nodes.front());
      if (parts.empty() || shine(parts)) continue;
      const std::string& own = stage_.model.meshes[static_cast<size_t>(mesh)].name;
      const std::string& first = stage_.model.nodes[static_cast<size_t>(shared.nodes.front())].name;
      for (Part& part : parts) part.name = own.empty() ? first : own;
      const std::string file = stage_.places.shared_name(mesh, stage_.clip, stage_.animation);
      if (Status s = put_group(own.empty() ? first : own, file, parts, {}); !s) return s;
      for (const Part& part : parts) {
        if (Status s = extend_bounds(part, Affine(), shared.places); !s) return s;
      }
      for (const int node : shared.nodes) told_[static_cast<size_t>(node)] = 1;
    }
    return {};
  }

  Status node(int index) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    if (node.mesh < 0 || told_[static_cast<size_t>(index)] != 0) return {};
    const std::vector<Part> parts = parts_of(index);
    if (parts.empty()) return {};
    std::vector<YamlPtr> steps;
    // A skin places its mesh by its bones alone (glTF 2.0, section 3.7.3.3).
    if (node.skin < 0) {
      steps = transform_steps(stage_.model, stage_.clip, index, stage_.frames);
    }
    if (!node.instances.empty()) return copies(index, parts, steps);
    for (const Part& part : parts) {
      if (Status s = put(part.name, part.object, steps); !s) return s;
    }
    return extend_bounds(index, parts, {});
  }

  GltfObjects out;

 private:
  /// A primitive of a node's mesh as an object without its place.
  struct Part {
    std::string name;
    YamlMap object;
    const GltfMeshFile* file = nullptr;
    const GltfPrimitive* primitive = nullptr;
    bool shines = false;
  };

  /// Whether it has too few corners for a triangle. Of packed ones that is seen when they are read.
  bool is_empty(const GltfPrimitive& primitive) const {
    if (primitive.draco) return false;
    const auto position = primitive.attributes.find("POSITION");
    int accessor = primitive.indices;
    if (accessor < 0 && position != primitive.attributes.end()) accessor = position->second;
    return accessor >= 0 && stage_.model.accessors[static_cast<size_t>(accessor)].count < 3;
  }

  void leave_out(const GltfPrimitive& primitive, const std::string& why) {
    if (left_out_.insert(primitive.place).second) stage_.notes.push_back(primitive.place + why);
  }

  std::vector<Part> parts_of(int index) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    const GltfMesh& mesh = stage_.model.meshes[static_cast<size_t>(node.mesh)];
    std::vector<Part> parts;
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      const GltfPrimitive& primitive = mesh.primitives[p];
      if (!has_triangles(primitive)) {
        leave_out(primitive,
                  std::string(" is made of ") + kModes[primitive.mode] + ", which are left out");
      } else if (is_empty(primitive)) {
        leave_out(primitive, " has no triangles and is left out");
      } else {
        parts.push_back(part_of(index, p));
        std::string& name = parts.back().name;
        name = !node.name.empty() ? node.name : mesh.name;
        if (mesh.primitives.size() > 1) name += (name.empty() ? "" : ".") + std::to_string(p + 1);
      }
    }
    return parts;
  }

  Part part_of(int index, size_t p) {
    Part part;
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    part.primitive = &stage_.model.meshes[static_cast<size_t>(node.mesh)].primitives[p];
    const GltfMaterial& material =
        materials_.get(part.primitive->material, part.primitive->attributes.count("COLOR_0") != 0);
    part.file = &stage_.files.file(index, p);
    part.shines = material.shines;
    const bool deforms = stage_.clip != nullptr && stage_.files.changes(*part.file, *stage_.clip);
    const std::string folder =
        deforms ? stage_.files.folder(stage_.frames.fps, stage_.animation, stage_.frames.loop())
                : "";
    part.object.put("mesh",
                    yaml_text(fmt::format("{}meshes/{}{}{}.ply", stage_.request.made, folder,
                                          part.file->name, deforms ? ".####" : "")));
    part.object.put("material", yaml_text(material.name));
    if (!material.interior.empty()) part.object.put("interior", yaml_text(material.interior));
    if (material.emit) part.object.put("emit", material.emit);
    return part;
  }

  /// EXT_mesh_gpu_instancing.
  Status copies(int index, const std::vector<Part>& parts, const std::vector<YamlPtr>& steps) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    copies_ += count_copies(stage_.model, node);
    if (copies_ > kMostCopies) {
      return stage_.model.error(
          fmt::format("nodes[{}] and those before it have {} instances; at most {} are possible",
                      index, copies_, kMostCopies));
    }
    auto copies = copies_of(stage_.model, index);
    if (!copies) return copies.error();
    if (copies->vanished > 0) {
      stage_.notes.push_back(fmt::format("nodes[{}] has {} instances of size 0, which are left out",
                                         index, copies->vanished));
    }
    std::vector<PlaceMatrix>& in_file = copies->in_file;
    if (Status s = extend_bounds(index, parts, in_file); !s) return s;
    if (Status s = extend_bounds(index, parts, copies->single); !s) return s;
    if (shine(parts) || in_file.size() < kFewestCopies ||
        may_vanish(stage_.model, stage_.clip, index)) {
      if (Status s = put_each(in_file, parts, steps); !s) return s;
    } else {
      in_file = {};
      const std::string& mesh = stage_.model.meshes[static_cast<size_t>(node.mesh)].name;
      const std::string& name = node.name.empty() ? mesh : node.name;
      if (Status s = put_group(name, stage_.places.name(index), parts, steps); !s) return s;
    }
    return put_each(copies->single, parts, steps);
  }

  Status put_each(const std::vector<PlaceMatrix>& places, const std::vector<Part>& parts,
                  const std::vector<YamlPtr>& steps) {
    for (const Part& part : parts) {
      for (const PlaceMatrix& place : places) {
        std::vector<YamlPtr> moved{matrix_step(place_matrix(place))};
        moved.insert(moved.end(), steps.begin(), steps.end());
        if (Status s = put(part.name, part.object, moved); !s) return s;
      }
    }
    return {};
  }

  static bool shine(const std::vector<Part>& parts) {
    return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.shines; });
  }

  /// Copies of `parts` at the places of `file`, as a group and an object.
  Status put_group(const std::string& name, const std::string& file, const std::vector<Part>& parts,
                   const std::vector<YamlPtr>& steps) {
    Names inside("object");
    YamlMap members;
    for (const Part& part : parts) members.put(inside.add(part.name), part.object);
    const std::string group = group_names_.add(name);
    const YamlMap body{{"objects", members.node()}};
    weight_ += body.node()->weight;
    out.groups.put(group, body);
    const YamlMap object{{"instance", yaml_text(group)},
                         {"places", yaml_text(stage_.request.made + file)}};
    return put(name, object, steps);
  }

  Status put(const std::string& name, YamlMap object, const std::vector<YamlPtr>& steps) {
    if (!steps.empty()) object.put("transform", yaml_list(steps));
    const YamlPtr made = object.node();
    weight_ += made->weight;
    if (weight_ > kMaxYamlNodes) {
      return stage_.model.error(
          fmt::format("its nodes and keys take more than {} values, the most that a job may have",
                      kMaxYamlNodes));
    }
    out.section.put(names_.add(name), made);
    return {};
  }

  /// Of a part of a node, in the space of its mesh (of a skin's, in that of the scene).
  Result<Bounds> own_bounds(const Part& part) const {
    const auto position = part.primitive->attributes.find("POSITION");
    Bounds own;
    const auto* extent =
        position == part.primitive->attributes.end()
            ? nullptr
            : &stage_.model.accessors[static_cast<size_t>(position->second)].extent;
    if (part.file->node < 0 && extent != nullptr && extent->has_value()) {
      own.include((**extent)[0]);
      own.include((**extent)[1]);
      return own;
    }
    const auto geometry = shaped_geometry(stage_.model, *part.file, stage_.clip, 0.0);
    if (!geometry) return geometry.error();
    for (const Vec3& p : geometry->positions) own.include(p);
    return own;
  }

  /// `places`: of its copies, in the space of the node; none: it stands there itself.
  Status extend_bounds(int index, const std::vector<Part>& parts,
                       const std::vector<PlaceMatrix>& places) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    if (places.empty() && !node.instances.empty()) return {};
    const Affine world(node.skin >= 0 ? Mat4(1.0F)
                                      : world_matrix(stage_.model, stage_.clip, index, 0.0));
    for (const Part& part : parts) {
      if (Status s = extend_bounds(part, world, places); !s) return s;
    }
    return {};
  }

  Status extend_bounds(const Part& part, const Affine& world,
                       const std::vector<PlaceMatrix>& places) {
    const auto own = own_bounds(part);
    if (!own) return own.error();
    if (own->empty()) return {};
    if (places.empty()) out.bounds.include(transform_bounds(world, *own));
    for (const PlaceMatrix& place : places) {
      out.bounds.include(transform_bounds(world * Affine(place_matrix(place)), *own));
    }
    return {};
  }

  const GltfStage& stage_;
  GltfMaterials& materials_;
  Names names_;
  Names group_names_;
  std::set<std::string> left_out_;
  uint64_t weight_ = 0;
  std::vector<uint8_t> told_;  ///< by node: whether it is among the copies of a mesh
  size_t copies_ = 0;
};

}  // namespace

Result<GltfObjects> write_objects(const GltfStage& stage, GltfMaterials& materials) {
  ObjectWriter writer(stage, materials);
  if (Status s = writer.shared_meshes(); !s) return s.error();
  for (const int node : stage.model.order) {
    if (Status s = writer.node(node); !s) return s.error();
  }
  return std::move(writer.out);
}

}  // namespace hyades::core
