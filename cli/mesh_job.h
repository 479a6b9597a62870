#pragma once

#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"

namespace hyades::cli {

/// A mesh to be rendered by itself. References are relative to the folder of `assets`.
struct MeshJobFiles {
  std::string mesh;
  std::string media;  ///< file of media for the mesh's materials; empty: none
};

/// The text of a job that shows the mesh in a good light: a three-quarter view that fits it, a
/// ground under it, a soft key light and a pale sky. A material of an OBJ file (usemtl) is filled
/// with the medium that has its name, with a surface of the medium's index of refraction; the
/// others have colour, light and index of the file's MTL, or are warm clay. Without media that fit,
/// the job is an error that names both sides.
core::Result<std::string> mesh_job_text(const MeshJobFiles& files, core::AssetResolver& assets);

}  // namespace hyades::cli
