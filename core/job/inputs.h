#pragma once

#include <string>

#include "core/job/animated.h"

namespace hyades::core {

/// Which files of a sequence, that has one for each frame, a frame looks at: its own alone, or, for
/// what happens while its shutter is open, also that of the next one.
enum class FrameFiles { own, own_and_next };

/// A colour that is a value or comes from a named texture.
struct ColorInput {
  Animated<Rgb> value{Rgb(1.0F)};
  std::string texture;  ///< name in Job::textures; empty = use value
};

/// A number that is a value or comes from a named texture (its scalar).
struct ScalarInput {
  Animated<float> value{0.0F};
  std::string texture;
};

}  // namespace hyades::core
