#pragma once

#include <vector>

#include "core/job/job.h"
#include "core/media/make_medium.h"
#include "core/scene/volume_makers.h"

namespace hyades::core {

/// The coefficients that `desc` gives at `time`, per metre; where it varies, those of density 1.
Coefficients coefficients_of(const MediumDesc& desc, const JobTime& time, float units);

/// The medium that `desc` describes at `time`, in metres; `units` is the length of one unit of the
/// job.
MediumPtr make_medium(const MediumDesc& desc, const JobTime& time, float units);

/// The medium that `desc` describes at `time`, in metres, which varies as `volume` in a body, which
/// is put into the world by `body_to_world` as placements are.
MediumPtr make_medium_in(const MediumDesc& desc, const JobTime& time, float units,
                         const PlacedVolume& volume, const std::vector<Mat4>& body_to_world);

/// What fills bodies of a material that has a `subsurface`.
MediumPtr make_subsurface(const MaterialDesc& desc, const JobTime& time, float units);

}  // namespace hyades::core
