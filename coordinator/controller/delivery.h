#pragma once

#include <cstddef>
#include <vector>

#include "coordinator/controller/active_job.h"
#include "core/film/film.h"

namespace hyades::coordinator {

/// A result on its way through the scheduler.
struct Delivery {
  core::Film film;
  std::vector<std::byte> record;  ///< encode_delivered
  AcceptedUnit unit;
  FilmUnderWay rendered;
  bool settled = false;  ///< it is on its way to the disk, or was answered
};

}  // namespace hyades::coordinator
