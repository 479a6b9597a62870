#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace hyades::coordinator {

/// The whole number that the text is, all of it; nothing where it is none, or too large.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// What a value of a query means that says yes or no ("", "true", "1"; "false", "0"); nothing where
/// it is neither.
inline std::optional<bool> flag_of(std::string_view text) {
  if (text.empty() || text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

}  // namespace hyades::coordinator
