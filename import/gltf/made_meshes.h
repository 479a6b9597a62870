#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/mutex.h"
#include "import/gltf/animation.h"
#include "import/gltf/model.h"

namespace hyades::core {

/// One mesh file that is made of a primitive.
struct GltfMeshFile {
  std::string name;  ///< "body": of the file, without folder and ending
  int mesh = 0;
  size_t primitive = 0;
  int node = -1;  ///< whose skin and weights shape it; -1: it is as it is
};

/// The mesh files of a scene: which there are, and their bytes. Immutable but for what it
/// remembers of animations, which is guarded; thread-safe.
class GltfMeshFiles {
 public:
  explicit GltfMeshFiles(std::shared_ptr<const GltfModel> model);

  /// Vertices or triangles of all files together, as far as accessors say it.
  uint64_t elements() const { return elements_; }

  /// The file of a primitive of a node's mesh.
  const GltfMeshFile& file(int node, size_t primitive) const;

  /// Whether clip `clip` changes the mesh of `file`.
  bool changes(const GltfMeshFile& file, const GltfClip& clip) const;

  /// The bytes of "meshes/<name>.ply", the mesh at rest, or of
  /// "meshes/<fps>/<clip>/<name>.<frame>.ply", "meshes/loop/<fps>/<clip>/<name>.<frame>.ply".
  Result<Bytes> made(const std::string& name) const;

  /// What stands between "meshes/" and the mesh's name: "24/Walk/", or "loop/24/Walk/" where the
  /// clip begins again when it ends.
  std::string folder(float fps, size_t animation, bool loop) const;

  /// Animation `index`, read once.
  Result<std::shared_ptr<const GltfClip>> clip(size_t index) const;

  /// The name of its folder, by which animation_named() finds it too.
  const std::string& clip_name(size_t animation) const { return clip_folders_[animation]; }

  /// The animation whose folder this is.
  std::optional<size_t> clip_in_folder(std::string_view folder) const;

  /// The number of the animation of this name: its own or that of its folder; or -1.
  int animation_named(const std::string& name) const;

 private:
  std::shared_ptr<const GltfModel> model_;
  std::vector<GltfMeshFile> files_;
  uint64_t elements_ = 0;
  std::map<std::string, size_t> by_name_;
  std::map<std::pair<int, size_t>, size_t> of_node_;
  std::vector<std::string> clip_folders_;
  mutable Mutex mutex_;
  mutable std::map<size_t, std::shared_ptr<const GltfClip>> clips_ HYADES_GUARDED_BY(mutex_);
};

/// The geometry of a mesh file: as it is; or, where it belongs to a node, morphed and moved by its
/// bones at `time`, in the space of the scene if the node has a skin.
Result<struct GltfGeometry> shaped_geometry(const GltfModel& model, const GltfMeshFile& file,
                                            const GltfClip* clip, double time);

}  // namespace hyades::core
