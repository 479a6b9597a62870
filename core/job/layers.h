#pragma once

#include "core/film/layout.h"
#include "core/job/job.h"

namespace hyades::core {

/// Whether light paths of the integrator may end at any pixel of the frame, so that films need a
/// layer for what they bring (LayerSet::splats).
bool makes_splats(const IntegratorDesc& integrator);

/// The layers that a film must hold so that all of the job's outputs can be made from it.
LayerSet needed_layers(const Job& job);

}  // namespace hyades::core
