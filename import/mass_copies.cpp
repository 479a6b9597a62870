#include "import/mass_copies.h"

#include "core/geometry/placement_check.h"

namespace hyades::core {

namespace {

/// Files refuse copies below a hundred-thousandth; the job around the scene may shrink it.
constexpr float kMargin = 0.1F;

}  // namespace

bool can_be_copied(const Mat4& in_scene) {
  Mat4 smaller = in_scene;
  for (int c = 0; c < 3; ++c) smaller[c] *= kMargin;
  return can_be_instanced(smaller);
}

}  // namespace hyades::core
