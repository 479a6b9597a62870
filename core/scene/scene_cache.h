#pragma once

#include <compare>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/base/mutex.h"
#include "core/geometry/closed_mesh.h"
#include "core/geometry/curve_set.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/world.h"
#include "core/image/read_image.h"
#include "core/lights/environment_map.h"
#include "core/lights/gobo.h"
#include "core/lights/sky.h"
#include "core/media/grid_fields.h"
#include "core/media/majorant_grid.h"
#include "core/scene/once_map.h"
#include "core/textures/pyramid.h"

namespace hyades::core {

/// Which normals a mesh gets: those of its file (or of its triangles, where it has none), those of
/// its triangles, or smooth ones.
enum class MeshNormals { file, flat, smooth };

/// What of meshes besides their shape anything in a job looks at; the rest is not kept.
struct MeshExtras {
  bool tangents = false;    ///< those of the file or TriangleMesh::tangents, for normal maps
  bool colors = false;      ///< of vertices
  bool second_uvs = false;  ///< of vertices
  auto operator<=>(const MeshExtras&) const = default;
};

/// What of a mesh's file is asked for.
struct MeshUse {
  MeshUse(MeshNormals which, std::string material = {})  // NOLINT: implicit, mostly it is just that
      : normals(which), part(std::move(material)) {}
  MeshNormals normals;
  std::string part;  ///< the material (usemtl) whose triangles are meant; empty: all
  MeshExtras extras;
  auto operator<=>(const MeshUse&) const = default;
};

/// How a texture reads an image's file.
struct ImageUse {
  ColorSpace space = ColorSpace::automatic;
  WrapModes wrap{};
  auto operator<=>(const ImageUse&) const = default;
};

/// A grid of a .vdb.
struct VdbUse {
  std::string file;
  std::string grid;
  bool of_frame = false;  ///< only some frames look at it: kept as long as somebody uses it
  auto operator<=>(const VdbUse&) const = default;
};

/// A grid as a density, in the space of its voxels.
struct VdbDensity {
  std::shared_ptr<const VdbGrid<float>> grid;
  std::shared_ptr<const DensityField> field;
  std::shared_ptr<const MajorantGrid> majorants;
};

/// What the frames of a job share: meshes, images, acceleration structures, and the whole world
/// while nothing in it moves. Thread-safe: the next frame's scene loads while this one renders, and
/// several files load at once.
class SceneCache {
 public:
  /// Texels are kept in `texels`, which several caches may share.
  explicit SceneCache(AssetResolver& assets,
                      std::shared_ptr<TexelStore> texels = std::make_shared<TexelStore>())
      : assets_(assets), texels_(std::move(texels)) {}

  Result<std::shared_ptr<const TriangleMesh>> mesh(const std::string& file, const MeshUse& use);

  /// A mesh of a file that some frames look at only: kept as long as somebody uses the mesh, so
  /// that frames leave nothing behind.
  Result<std::shared_ptr<const TriangleMesh>> frame_mesh(const std::string& file,
                                                         const MeshUse& use);

  /// Where the copies of an instancer stand.
  Result<std::shared_ptr<const std::vector<PlaceMatrix>>> places(const std::string& file);

  /// The strands of a file whose points mean `basis`.
  Result<std::shared_ptr<const CurveSet>> curves(const std::string& file, CurveBasis basis);

  /// Whether there is such a file.
  bool exists(const std::string& file) { return assets_.exists(file); }

  Result<std::shared_ptr<const Image>> image(const std::string& file, ColorSpace space);

  /// An image at all its sizes, for textures.
  Result<PyramidPtr> pyramid(const std::string& file, const ImageUse& use);

  /// The tiles that a UDIM pattern has, by number.
  Result<std::shared_ptr<const std::vector<int>>> udim(const std::string& pattern);

  /// An image as a sky, ready to be sampled.
  Result<std::shared_ptr<const EnvironmentMap>> environment_map(const std::string& file,
                                                                SkyDensity density);

  /// An image as a projector's picture, ready to be sampled.
  Result<std::shared_ptr<const Gobo>> gobo(const std::string& file);

  /// A clear sky; the previous one where the settings are the same.
  std::shared_ptr<const Sky> sky(const SkySettings& settings);

  /// A grid of numbers of a .vdb, and what tracking needs to know of it as a density.
  Result<std::shared_ptr<const VdbGrid<float>>> vdb_numbers(const VdbUse& use);
  Result<std::shared_ptr<const VdbDensity>> vdb_density(const VdbUse& use);

  /// A grid of colours of a .vdb.
  Result<std::shared_ptr<const VdbGrid<Rgb>>> vdb_colors(const VdbUse& use);

  /// A mesh made here (rectangle, box), shared between equal requests under `key`.
  std::shared_ptr<const TriangleMesh> made_mesh(const std::string& key,
                                                std::shared_ptr<TriangleMesh> (*make)(const Vec3&),
                                                const Vec3& size);

  /// A displaced mesh, shared between equal requests under `key` while a scene uses it and until
  /// the world after it is made, so that frames with other heights leave nothing behind; `make()`
  /// returns a Result of it.
  template <class Make>
  Result<std::shared_ptr<const TriangleMesh>> displaced(const std::string& key, const Make& make) {
    return displaced_.get(key, make);
  }

  /// Whether a mesh of this cache has an inside.
  MeshClosure closure(const std::shared_ptr<const TriangleMesh>& mesh);

  /// The world of `placements` in a class; the previous one where they are the same.
  Result<std::shared_ptr<const World>> world(std::vector<Placement> placements, RenderClass which);

  /// Bytes of all images' pixels.
  size_t image_memory() const;

 private:
  template <class Value>
  struct VdbMap {
    OnceMap<VdbUse, Value> kept;
    WeakMap<VdbUse, Value> of_frames;

    template <class Make>
    Result<std::shared_ptr<const Value>> get(const VdbUse& use, const Make& make) {
      return use.of_frame ? of_frames.get(use, make) : kept.get(use, make);
    }
  };

  /// A file cut into its materials; one of frames is kept for a while only.
  Result<std::shared_ptr<const MeshParts>> parts_of(const std::string& file, bool of_frames);

  /// One part of a mesh, or all of it, made ready for `use`.
  Result<std::shared_ptr<const TriangleMesh>> read(const std::string& file, const MeshUse& use,
                                                   bool of_frames);

  AssetResolver& assets_;
  std::shared_ptr<TexelStore> texels_;
  OnceMap<std::pair<std::string, MeshUse>, TriangleMesh> meshes_;
  OnceMap<std::string, MeshParts> mesh_parts_;
  WeakMap<std::pair<std::string, MeshUse>, TriangleMesh> frame_meshes_;
  WeakMap<std::string, MeshParts> frame_parts_;
  OnceMap<std::string, std::vector<PlaceMatrix>> places_;
  OnceMap<std::pair<std::string, CurveBasis>, CurveSet> curves_;
  Mutex recent_parts_mutex_;
  /// So that the parts of a frame's file come from one reading.
  std::deque<std::shared_ptr<const MeshParts>> recent_parts_ HYADES_GUARDED_BY(recent_parts_mutex_);
  WeakMap<std::string, TriangleMesh> made_meshes_;
  WeakMap<std::string, TriangleMesh> displaced_;
  /// By meshes that it does not keep.
  OnceMap<std::weak_ptr<const TriangleMesh>, MeshClosure, std::owner_less<>> closures_;
  OnceMap<std::pair<std::string, ColorSpace>, Image> images_;
  OnceMap<std::pair<std::string, ImageUse>, ImagePyramid> pyramids_;
  OnceMap<std::string, std::vector<int>> udims_;
  OnceMap<std::pair<std::string, SkyDensity>, EnvironmentMap> environment_maps_;
  OnceMap<std::string, Gobo> gobos_;
  VdbMap<VdbGrid<float>> vdb_numbers_;
  VdbMap<VdbGrid<Rgb>> vdb_colors_;
  VdbMap<VdbDensity> vdb_densities_;
  Mutex sky_mutex_;
  SkySettings sky_settings_ HYADES_GUARDED_BY(sky_mutex_);
  std::shared_ptr<const Sky> sky_ HYADES_GUARDED_BY(sky_mutex_);
  GeometryCache geometry_;
  Mutex world_mutex_;
  RenderClass world_class_ HYADES_GUARDED_BY(world_mutex_) = RenderClass::native;
  std::vector<Placement> world_placements_ HYADES_GUARDED_BY(world_mutex_);
  std::shared_ptr<const World> world_ HYADES_GUARDED_BY(world_mutex_);
};

}  // namespace hyades::core
