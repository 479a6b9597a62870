#pragma once

#include <string_view>

#include "core/base/result.h"

namespace hyades::core::pbrt {

/// The focal length, mm, of a file of lens elements from front to back: rows of radius [mm], way to
/// the next [mm], index behind and diameter [mm]; radius 0 is the stop. By rays near the axis.
/// Errors: no such rows, or a lens that does not gather light.
Result<double> focal_length(std::string_view lens_file);

}  // namespace hyades::core::pbrt
