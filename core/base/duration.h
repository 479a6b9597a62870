#pragma once

#include <chrono>
#include <string_view>

#include "core/base/result.h"

namespace hyades::core {

/// A length of time as people write it, in seconds: a number and s, m, h or d ("90s", "5m",
/// "1.5h", "30d"), several in falling order ("1h30m"), or a number alone, which is seconds. At most
/// a thousand years; anything else, also a negative one, is an error that says what was expected.
Result<double> parse_duration(std::string_view text);

/// How many seconds `time` has.
template <class Rep, class Period>
constexpr double seconds(std::chrono::duration<Rep, Period> time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace hyades::core
