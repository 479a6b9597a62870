#pragma once

#include <cstdint>
#include <string>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::cli {

/// What the films of a job take, and what there is for them on this machine, in bytes.
struct FilmRoom {
  core::PixelRect window;  ///< what is rendered of each frame
  uint64_t channels = 0;
  uint64_t film = 0;  ///< of one frame
  uint64_t most = 0;  ///< that films may take
  uint64_t here = 0;  ///< memory that this process may take; 0: not known

  /// An error where not even one film has room.
  core::Status check() const;

  /// How many frames may be in work together: as many as there is room for, up to the usual number.
  uint32_t frames_in_flight() const;
};

/// The films of `job` on this machine; `most` 0: half of the memory, for the pictures that are made
/// of a film, scenes and all else have to fit in too.
FilmRoom film_room(const core::Job& job, const core::PixelRect& window, uint64_t most = 0);

}  // namespace hyades::cli
