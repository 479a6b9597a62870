#include "tests/support/random.h"

#include <cmath>

namespace hyades::test {

core::Vec3 Random::direction() {
  const double z = 2.0 * uniform_double() - 1.0;
  const double phi = 2.0 * M_PI * uniform_double();
  const double r = std::sqrt(1.0 - z * z);
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
          static_cast<float>(z)};
}

}  // namespace hyades::test
