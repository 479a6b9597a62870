#include "core/base/duration.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <system_error>

namespace hyades::core {
namespace {

constexpr double kLongest = 1000 * 365.25 * 86400;

/// Seconds of a unit; 0 where it is none.
double seconds_of(char unit) {
  switch (unit) {
    case 's':
      return 1;
    case 'm':
      return 60;
    case 'h':
      return 3600;
    case 'd':
      return 86400;
    default:
      return 0;
  }
}

}  // namespace

Result<double> parse_duration(std::string_view text) {
  const Error wrong{std::string(text) + ": expected a length of time such as 90s, 5m, 1.5h or 30d"};
  double total = 0;
  double last_unit = std::numeric_limits<double>::infinity();
  std::string_view rest = text;
  if (rest.empty()) return wrong;
  while (!rest.empty()) {
    double number = 0;
    const auto [end, failed] =
        std::from_chars(rest.data(), rest.data() + rest.size(), number, std::chars_format::fixed);
    if (failed != std::errc() || !std::isfinite(number) || std::signbit(number)) return wrong;
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    if (rest.empty() && total == 0 && std::isinf(last_unit)) {
      total = number;
      break;
    }
    const double unit = rest.empty() ? 0 : seconds_of(rest.front());
    if (unit == 0 || unit >= last_unit) return wrong;
    rest.remove_prefix(1);
    last_unit = unit;
    total += number * unit;
  }
  if (total > kLongest) return wrong;
  return total;
}

}  // namespace hyades::core
