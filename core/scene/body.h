#pragma once

#include <cstdint>
#include <string>

#include "core/media/make_medium.h"

namespace hyades::core {

/// The inside of a closed surface, as light knows it that crosses the surface: all parts of the
/// surface (a cylinder and its caps) lead into one body.
struct Body {
  MediumPtr medium;         ///< what fills it; null: nothing
  std::string filled_with;  ///< the name of `medium` in the job; empty: nothing, or a subsurface
  float index = 0.0F;       ///< of refraction inside; 0: that of what is around (null surfaces)
  bool open = true;         ///< light comes in straight: the surface is null
  /// Where bodies overlap, the one of highest rank says what is there. No two are equal.
  uint32_t rank = 0;
  bool may_be_hidden = false;  ///< parts of its surface, by bodies of higher rank

  bool refracts() const { return index > 0.0F; }
};

}  // namespace hyades::core
