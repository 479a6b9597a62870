#pragma once

#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::cli {

/// A job that shows mesh file `reference` in a good light: a warm clay material, a three-quarter
/// view that fits the mesh, a ground under it, a soft key light and a pale sky. Writes NAME.exr and
/// NAME.png.
core::Result<core::Job> make_mesh_job(const std::string& reference, core::AssetResolver& assets);

}  // namespace hyades::cli
