#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <system_error>

namespace hyades::core {

/// Reads a number at the start of [at, end): correctly rounded, whatever the locale. Accepts a
/// leading '+'. Too large gives infinity, too small 0. Returns the place after it, or null where
/// there is no number.
inline const char* scan_float(const char* at, const char* end, float& value) {
  if (at < end && *at == '+') ++at;
  const auto [after, error] = std::from_chars(at, end, value);
  if (error == std::errc()) return after;
  if (error != std::errc::result_out_of_range) return nullptr;
  double wide = 0.0;
  const bool fits = std::from_chars(at, end, wide).ec == std::errc();
  const std::string_view text(at, static_cast<size_t>(after - at));
  const bool small =
      fits ? std::abs(wide) < 1.0 : text.find("e-") != text.npos || text.find("E-") != text.npos;
  value = small ? 0.0F : std::numeric_limits<float>::infinity();
  return after;
}

/// Reads an integer as scan_float() reads a number.
template <class Integer>
const char* scan_integer(const char* at, const char* end, Integer& value) {
  if (at < end && *at == '+') ++at;
  const auto [after, error] = std::from_chars(at, end, value);
  return error == std::errc() ? after : nullptr;
}

inline bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

}  // namespace hyades::core
