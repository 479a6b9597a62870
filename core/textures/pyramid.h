#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/image/image.h"
#include "core/textures/texels.h"
#include "core/textures/wrap.h"

namespace hyades::core {

/// An image at all its sizes (Williams 1983, "Pyramidal Parametrics"): level 0 is the image,
/// exactly; each further one has half as many texels along both sides, rounded down, to a single
/// one. They are filtered from the level before by a tent as wide as two of its texels on either
/// side, in linear light, across the edges as `wrap` has it. Colours count by their alpha, so that
/// what shows through a hole does not darken its rim. Immutable.
class ImagePyramid {
 public:
  /// Colour from channels R, G, B, else grey from Y, else from the first channel; alpha from A. An
  /// image without pixels has no levels. Errors: no room in `store`.
  static Result<std::shared_ptr<const ImagePyramid>> make(const Image& image, WrapModes wrap,
                                                          TexelStore& store);

  const std::vector<Texels>& levels() const { return levels_; }
  WrapModes wrap() const { return wrap_; }
  size_t memory() const;  ///< bytes of texels

 private:
  std::vector<Texels> levels_;
  WrapModes wrap_;
};

using PyramidPtr = std::shared_ptr<const ImagePyramid>;

}  // namespace hyades::core
