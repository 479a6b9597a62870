#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/mtl_file.h"
#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace hyades::cli {

/// What one material of a mesh's file becomes.
struct ShownPart {
  std::string name;        ///< as objects and materials of a job may be called; no two are the same
  std::string part;        ///< the material in the mesh's file; empty: all of the mesh
  std::string medium;      ///< what fills it; empty: nothing
  bool has_index = false;  ///< whether the medium brings its surface
  MtlMaterial look;        ///< of its surface
};

struct ShownMesh {
  core::Bounds bounds;
  std::vector<ShownPart> parts;
};

/// A name for files, folders, objects and materials out of any text: what is not a letter, a digit
/// or one of _-. becomes '-', and it begins with a letter or digit, so that it can neither hide nor
/// lead out of a folder. "mesh" where nothing is left.
std::string safe_name(const std::string& text);

/// Reads mesh `file` and decides what its materials are; `media` is a file of media or empty.
/// A file of materials that is missing is told on standard error, and is no error.
core::Result<ShownMesh> show_mesh(const std::string& file, const std::string& media,
                                  core::AssetResolver& assets);

}  // namespace hyades::cli
