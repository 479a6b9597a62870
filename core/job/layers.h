#pragma once

#include "core/film/layout.h"
#include "core/job/job.h"

namespace hyades::core {

/// The layers that a film must hold so that all of the job's outputs can be made from it.
LayerSet needed_layers(const Job& job);

}  // namespace hyades::core
