#include "core/job/value_checks.h"

#include <fmt/format.h>

namespace hyades::core {

bool Range::contains(double x) const {
  const bool within = x >= low && x <= high;
  if (!within) return false;
  const auto rounded = static_cast<float>(x);
  if (low_open && !(rounded > static_cast<float>(low))) return false;
  return !high_open || rounded < static_cast<float>(high);
}

std::string Range::describe(const std::string& noun) const {
  const bool bounded_low = low > -1e18;
  const bool bounded_high = high < 1e18;
  if (!bounded_low && !bounded_high) return noun;
  if (!bounded_high) {
    return low_open ? fmt::format("{} above {}", noun, low) : fmt::format("{} >= {}", noun, low);
  }
  if (low_open && high_open) return fmt::format("{} above {} and below {}", noun, low, high);
  if (low_open) return fmt::format("{} above {}, at most {}", noun, low, high);
  return fmt::format("{} from {} to {}", noun, low, high);
}

}  // namespace hyades::core
