#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/film/coverage.h"

namespace hyades::core {

/// What of batches [0, batches) of the pixels of `crop` is not held, as disjoint boxes from the top
/// down; `held` lies within. Empty where all is there.
std::vector<CoverageBox> gaps(const Coverage& held, const PixelRect& crop, uint32_t batches);

/// The first few of the gaps of a film of `samples` per pixel in words: "pixels x 0 to 63, y 0 to
/// 31: samples 16 to 47; ... and 3 more".
std::string describe_gaps(const std::vector<CoverageBox>& gaps, uint32_t samples);

}  // namespace hyades::core
