#pragma once

#include <cstdint>

namespace hyades::core {

/// A moment of a job's animation. Frames may be fractional inside a shutter interval.
struct JobTime {
  double seconds = 0.0;  ///< `t` of expressions: (frame - 1) / fps
  double frame = 1.0;    ///< `frame` of expressions and keys
};

}  // namespace hyades::core
