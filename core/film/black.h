#pragma once

#include "core/film/film.h"

namespace hyades::core {

/// Whether no light has reached any pixel of the film, by samples or by splats.
bool is_black(const Film& film);

}  // namespace hyades::core
