#include "core/import/gltf/objects.h"

#include <fmt/format.h>

#include <set>

#include "core/import/gltf/geometry.h"
#include "core/import/gltf/instancing.h"

namespace hyades::core {

namespace {

constexpr const char* kModes[] = {"points", "lines", "line loops", "line strips"};

class Writer {
 public:
  Writer(const GltfStage& stage, GltfMaterials& materials)
      : stage_(stage), materials_(materials), names_("object", stage.request.prefix) {}

  Status node(int index) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    if (node.mesh < 0) return {};
    const GltfMesh& mesh = stage_.model.meshes[static_cast<size_t>(node.mesh)];
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
      const GltfPrimitive& primitive = mesh.primitives[p];
      if (!has_triangles(primitive)) {
        if (left_out_.insert(primitive.place).second) {
          stage_.notes.push_back(primitive.place + " is made of " + kModes[primitive.mode] +
                                 ", which are left out");
        }
        continue;
      }
      if (is_empty(primitive)) {
        if (left_out_.insert(primitive.place).second) {
          stage_.notes.push_back(primitive.place + " has no triangles and is left out");
        }
        continue;
      }
      if (Status s = part(index, p, mesh.primitives.size() > 1); !s) return s;
    }
    return {};
  }

  GltfObjects out;

 private:
  /// Whether it has too few corners for a triangle. Of packed ones that is seen when they are read.
  bool is_empty(const GltfPrimitive& primitive) const {
    if (primitive.draco) return false;
    const auto position = primitive.attributes.find("POSITION");
    int accessor = primitive.indices;
    if (accessor < 0 && position != primitive.attributes.end()) accessor = position->second;
    return accessor >= 0 && stage_.model.accessors[static_cast<size_t>(accessor)].count < 3;
  }

  Status part(int index, size_t p, bool one_of_several) {
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    const GltfMesh& mesh = stage_.model.meshes[static_cast<size_t>(node.mesh)];
    const GltfPrimitive& primitive = mesh.primitives[p];
    const GltfMaterial& material =
        materials_.get(primitive.material, primitive.attributes.count("COLOR_0") != 0);
    const GltfMeshFile& file = stage_.files.file(index, p);
    const bool deforms = stage_.clip != nullptr && stage_.files.changes(file, *stage_.clip);
    YamlMap object;
    const std::string folder =
        deforms ? stage_.files.folder(stage_.frames.fps, stage_.animation) : "";
    object.put("mesh", yaml_text(fmt::format("{}meshes/{}{}{}.ply", stage_.request.made, folder,
                                             file.name, deforms ? ".####" : "")));
    object.put("material", yaml_text(material.name));
    if (!material.interior.empty()) object.put("interior", yaml_text(material.interior));
    if (material.emit) object.put("emit", material.emit);
    std::vector<YamlPtr> steps;
    // A skin places its mesh by its bones alone (glTF 2.0, section 3.7.3.3).
    if (node.skin < 0) {
      steps = transform_steps(stage_.model, stage_.clip, index, stage_.frames);
    }
    std::string name = !node.name.empty() ? node.name : mesh.name;
    if (one_of_several) {
      name += (name.empty() ? "" : ".") + std::to_string(p + 1);
    }
    if (node.instances.empty()) {
      if (Status s = extend_bounds(index, file, primitive, {Mat4(1.0F)}); !s) return s;
      return put(name, object, steps);
    }
    auto places = instance_places(stage_.model, node.instances);
    if (!places) return places.error();
    if (Status s = extend_bounds(index, file, primitive, *places); !s) return s;
    for (const Mat4& place : *places) {
      std::vector<YamlPtr> moved{matrix_step(place)};
      moved.insert(moved.end(), steps.begin(), steps.end());
      if (Status s = put(name, object, moved); !s) return s;
    }
    return {};
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

  /// `places`: of its copies, in the space of the node.
  Status extend_bounds(int index, const GltfMeshFile& file, const GltfPrimitive& primitive,
                       const std::vector<Mat4>& places) {
    const auto position = primitive.attributes.find("POSITION");
    const GltfNode& node = stage_.model.nodes[static_cast<size_t>(index)];
    Bounds own;
    const auto* extent =
        position == primitive.attributes.end()
            ? nullptr
            : &stage_.model.accessors[static_cast<size_t>(position->second)].extent;
    if (file.node < 0 && extent != nullptr && extent->has_value()) {
      own.include((**extent)[0]);
      own.include((**extent)[1]);
    } else {
      const auto geometry = shaped_geometry(stage_.model, file, stage_.clip, 0.0);
      if (!geometry) return geometry.error();
      for (const Vec3& p : geometry->positions) own.include(p);
    }
    const Mat4 world =
        node.skin >= 0 ? Mat4(1.0F) : world_matrix(stage_.model, stage_.clip, index, 0.0);
    for (size_t i = 0; i < 8 * places.size(); ++i) {
      const size_t corner = i % 8;
      const Vec3 p((corner & 1) != 0 ? own.upper.x : own.lower.x,
                   (corner & 2) != 0 ? own.upper.y : own.lower.y,
                   (corner & 4) != 0 ? own.upper.z : own.lower.z);
      out.bounds.include(transform_point(world, transform_point(places[i / 8], p)));
    }
    return {};
  }

  const GltfStage& stage_;
  GltfMaterials& materials_;
  Names names_;
  std::set<std::string> left_out_;
  uint64_t weight_ = 0;
};

}  // namespace

Result<GltfObjects> write_objects(const GltfStage& stage, GltfMaterials& materials) {
  Writer writer(stage, materials);
  for (const int node : stage.model.order) {
    if (Status s = writer.node(node); !s) return s.error();
  }
  return std::move(writer.out);
}

}  // namespace hyades::core
