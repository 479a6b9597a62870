#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/film/film_info.h"
#include "core/job/job.h"
#include "core/job/render_key.h"

namespace hyades::core {

/// Where the films of the job's finished frames go, below the output folder, if they are kept:
/// NAME.####.film.exr, or NAME.film.exr for a job of one frame. #### stands for the frame number.
std::string film_file(const Job& job);

/// What the film of a frame says of itself, and its pictures after it; `assets` as render_key() has
/// them. Without its worker class, which is that of those who render it.
FilmInfo film_info(const Job& job, int32_t frame, const std::vector<AssetRecord>& assets);

}  // namespace hyades::core
