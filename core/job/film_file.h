#pragma once

#include <string>

#include "core/job/job.h"

namespace hyades::core {

/// Where the films of the job's finished frames go, below the output folder, if they are kept:
/// NAME.####.film.exr, or NAME.film.exr for a job of one frame. #### stands for the frame number.
std::string film_file(const Job& job);

}  // namespace hyades::core
