#pragma once

#include "core/film/film.h"

namespace hyades::core {

/// What is said of a picture that is_black().
inline constexpr const char* kBlackWords = "black all over: no light reaches what the camera sees";

/// Whether no light has reached any pixel of the film, by samples or by splats.
bool is_black(const Film& film);

/// Whether every pixel's mean stays below `light` in all channels. Never where there are splats;
/// where pixels have different numbers of samples, about.
bool is_dimmer_than(const Film& film, double light);

}  // namespace hyades::core
