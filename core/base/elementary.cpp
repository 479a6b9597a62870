#include "core/base/elementary.h"

#include <cmath>

namespace hyades::core::elementary {

double reduce_huge(double x) {
  // fmod is exact in every C library, unlike the functions that this room replaces.
  return std::fmod(x, 2.0 * kPiD);
}

}  // namespace hyades::core::elementary
