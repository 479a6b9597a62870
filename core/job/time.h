#pragma once

#include <cstdint>

namespace hyades::core {

/// A moment of a job's animation. Frames may be fractional inside a shutter interval.
struct JobTime {
  double seconds = 0.0;  ///< `t` of expressions: (frame - 1) / fps
  double frame = 1.0;    ///< `frame` of expressions and keys
};

/// How many moments of an open shutter decide a frame, first and last included: the render key
/// looks at them, and motion is sampled at moments among them only.
inline constexpr int kShutterMoments = 17;

}  // namespace hyades::core
