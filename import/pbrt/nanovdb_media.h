#pragma once

#include "import/pbrt/medium_grids.h"

namespace hyades::core::pbrt {

/// Of a medium of type "nanovdb". One that does not glow is the scene's own file; one whose file
/// has temperatures is made anew, for jobs have no temperatures that begin elsewhere than at 0 and
/// no spectra that are brought to a peak of 1. Errors: no such file or grid, or too many points to
/// be made anew.
Result<MediumGrids> nanovdb_grids(Context& context, const NamedEntity& medium, bool check_only);

}  // namespace hyades::core::pbrt
