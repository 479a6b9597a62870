#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/geometry/swarm.h"
#include "core/import/gltf/model.h"

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

/// The files of places of a scene. Immutable and thread-safe.
class GltfPlaceFiles {
 public:
  explicit GltfPlaceFiles(std::shared_ptr<const GltfModel> model);

  /// "places/Tree.ply", of a node with instances.
  const std::string& name(int node) const { return names_.at(node); }

  /// The bytes of such a file, GltfCopies::in_file.
  Result<Bytes> made(const std::string& name) const;

 private:
  std::shared_ptr<const GltfModel> model_;
  std::map<int, std::string> names_;  ///< by node
};

}  // namespace hyades::core
