#pragma once

#include "core/textures/pyramid.h"

namespace hyades::core {

/// `image` at all its sizes, in memory.
inline PyramidPtr pyramid_of(const Image& image, WrapModes wrap) {
  TexelStore store;
  return *ImagePyramid::make(image, wrap, store);
}

}  // namespace hyades::core
