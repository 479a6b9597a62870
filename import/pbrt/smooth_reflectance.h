#pragma once

#include "import/pbrt/spectra.h"

namespace hyades::core::pbrt {

/// A smooth reflectance spectrum that looks as `color` (linear Rec.709, 0..1) by D65 light, as
/// nearly as there is one: a sigmoid of a parabola (Jakob and Hanika 2019, "A Low-Dimensional
/// Function Space for Efficient Spectral Upsampling"). It is what pbrt renders an rgb of a surface
/// with.
Spectrum smooth_reflectance(const Rgb& color);

}  // namespace hyades::core::pbrt
