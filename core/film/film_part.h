#pragma once

#include "core/base/rect.h"
#include "core/film/film.h"
#include "core/image/image.h"

namespace hyades::core {

/// What Film::normalised() shows of `part`, which lies inside the film's window, bit by bit. Takes
/// time for the part only, but for films with splats, where every pixel counts for each.
Image normalised_part(const Film& film, const PixelRect& part);

}  // namespace hyades::core
