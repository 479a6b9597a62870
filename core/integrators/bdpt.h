#pragma once

#include <memory>

#include "core/integrators/integrator.h"

namespace hyades::core {

/// Bidirectional path tracing (Veach 1997, chapter 10): with every camera path a light path, joined
/// in all ways at surfaces and in media, weighted by the power heuristic (path_vertex.h tells how).
/// The strategies: the camera path meets a light (s = 0), is joined to a place chosen on a light
/// (s = 1), to the light path (s, t > 1), or the light path to the lens (t = 1), which gives splats
/// anywhere on the film. Light that camera rays meet directly comes from s = 0 alone. Unbiased.
std::unique_ptr<Integrator> make_bdpt_integrator(const IntegratorDesc& desc);

}  // namespace hyades::core
