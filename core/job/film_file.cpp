#include "core/job/film_file.h"

namespace hyades::core {

std::string film_file(const Job& job) {
  return job.name + (job.frames.last > job.frames.first ? ".####.film.exr" : ".film.exr");
}

}  // namespace hyades::core
