#pragma once

#include <string>

#include "core/job/animated.h"

namespace hyades::core {

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
