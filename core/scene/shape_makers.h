#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/world.h"
#include "core/job/job.h"
#include "core/scene/displacement.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// What shapes need besides their description.
struct ShapeSetting {
  SceneCache& cache;
  JobTime time;       ///< when the shutter opens: shapes keep their sizes while it is open
  MeshExtras extras;  ///< what meshes need besides their shape
  /// How meshes are displaced that are; null: they stay as they are in
  /// their files, and only their places are of interest.
  const DisplacementSetting* displacement = nullptr;
  /// How far into the time to the next frame the shutter stays open: what a mesh with a file for
  /// each frame deforms by. 0: not at all.
  float shutter = 0.0F;
  std::string* notice = nullptr;  ///< gets what is probably not meant; null: nobody asks
};

/// The shape of an object (no group, no instance) in its own space, in the job's unit of length.
Result<Shape> make_shape(const ObjectDesc& object, const ShapeSetting& setting);

/// Whether the shape of `object` has other sizes at other times.
bool size_changes(const ObjectDesc& object);

/// What of its file the mesh `object` asks for.
Result<MeshUse> mesh_use_of(const ObjectDesc& object, const MeshExtras& extras);

/// What of its file the mesh `object` is made of where it is displaced.
MeshUse base_use_of(const ObjectDesc& object, const MeshExtras& extras);

/// What of meshes the materials and textures of the job look at.
MeshExtras mesh_extras_of(const Job& job);

/// The names that can be made: those of core/job/object_desc.h.
std::vector<std::string> made_shapes();
std::vector<std::string> made_mesh_normals();
std::vector<std::string> made_curve_bases();

}  // namespace hyades::core
