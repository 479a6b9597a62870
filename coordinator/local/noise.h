#pragma once

#include "core/film/film.h"

namespace hyades::coordinator {

/// The relative standard error of a film's beauty: the root of the mean variance of the pixels'
/// means over the mean luminance, estimated over batches on a grid of at most about 4000 pixels.
/// -1 where fewer than 16 of these pixels hold two batches, or all is black. Costs well below a
/// millisecond.
double estimate_noise(const core::Film& film);

}  // namespace hyades::coordinator
