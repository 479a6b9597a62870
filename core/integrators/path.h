#pragma once

#include <memory>

#include "core/integrators/integrator.h"

namespace hyades::core {

/// Unidirectional path tracing: at every surface light is estimated twice, by choosing a light and
/// by following the BSDF, joined by the power heuristic (Veach 1997, section 9.2.4). Unbiased
/// unless `clamp` is set.
std::unique_ptr<Integrator> make_path_integrator(const IntegratorDesc& desc);

}  // namespace hyades::core
