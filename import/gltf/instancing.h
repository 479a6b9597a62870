#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/geometry/point_instancer.h"
#include "import/gltf/made_meshes.h"
#include "import/gltf/model.h"

namespace hyades::core {

/// Where EXT_mesh_gpu_instancing places the copies of a node's mesh, in the node's space.
struct GltfCopies {
  std::vector<PlaceMatrix> in_file;  ///< what a file of places can say; none where they are few
  std::vector<PlaceMatrix> single;   ///< what has to be an object each
  size_t vanished = 0;               ///< how many have no size at all
};

/// The copies of node `node`. Errors: attributes of different lengths, numbers that cannot be read.
Result<GltfCopies> copies_of(const GltfModel& model, int node);

/// How many copies a node's attributes tell, without reading them.
size_t count_copies(const GltfModel& model, const GltfNode& node);

/// Nodes that show one mesh as it is, without instances of their own.
struct GltfSharedMesh {
  std::vector<PlaceMatrix> places;  ///< in the scene, of those that a file can tell
  std::vector<int> nodes;           ///< which these are
};

/// From so many nodes of a mesh on that stand still they are told by a file. Nodes have names, and
/// masks of their own as objects, which instances have not: so it takes more of them.
inline constexpr size_t kFewestNodes = 1024;

/// The files of places of a scene. `files` must outlive it. Immutable and thread-safe.
class GltfPlaceFiles {
 public:
  GltfPlaceFiles(std::shared_ptr<const GltfModel> model, const GltfMeshFiles& files);

  /// "places/Tree.ply", of a node with instances.
  std::string name(int node) const { return "places/" + names_.at(node) + ".ply"; }

  /// Meshes that kFewestNodes or more nodes show as they are.
  std::vector<int> shared_meshes() const;

  /// Where such a mesh stands still while `clip` (or none: null) is played; empty where too few do.
  GltfSharedMesh shared(int mesh, const GltfClip* clip) const;

  /// "places/Tree.ply" or, of a clip, "places/Walk/Tree.ply": the file of GltfSharedMesh::places.
  std::string shared_name(int mesh, const GltfClip* clip, size_t animation) const;

  /// The bytes of a file.
  Result<Bytes> made(const std::string& name) const;

 private:
  std::shared_ptr<const GltfModel> model_;
  const GltfMeshFiles& files_;
  std::map<int, std::string> names_;         ///< by node with instances
  std::map<int, std::vector<int>> nodes_;    ///< by mesh: nodes that show it as it is
  std::map<int, std::string> shared_names_;  ///< by mesh that many do
};

}  // namespace hyades::core
