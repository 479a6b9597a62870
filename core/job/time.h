#pragma once

#include <cstdint>

namespace hyades::core {

/// A moment of a job's animation. Frames may be fractional inside a shutter interval.
struct JobTime {
  double seconds = 0.0;  ///< `t` of expressions: (frame - 1) / fps
  double frame = 1.0;    ///< `frame` of expressions and keys
};

/// At how many moments of an open shutter, first and last included, values are tried for their
/// ranges and the camera is placed.
inline constexpr int kShutterMoments = 17;

/// How many moments of an open shutter decide a frame: the render key looks at them, and motion is
/// sampled at moments among them only. Those above are among them.
inline constexpr int kMostShutterMoments = 129;

}  // namespace hyades::core
