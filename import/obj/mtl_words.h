#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "core/geometry/text_scanner.h"

/// Words and numbers of a line of an MTL file.
namespace hyades::core {

/// `text` without blanks around it.
inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes the first word off `text`, and the blanks behind it.
inline std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  size_t end = 0;
  while (end < text.size() && !is_space(text[end])) ++end;
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

/// Reads finite numbers into `out`; how many there were, or -1 where something else stands there.
inline int read_numbers(std::string_view text, std::span<float> out) {
  const char* at = text.data();
  const char* const end = at + text.size();
  int count = 0;
  while (static_cast<size_t>(count) < out.size()) {
    while (at < end && is_space(*at)) ++at;
    if (at == end || *at == '#') break;
    float& number = out[static_cast<size_t>(count)];
    at = scan_float(at, end, number);
    if (at == nullptr || !std::isfinite(number)) return -1;
    ++count;
  }
  return count;
}

/// Whether all of `word` is one finite number.
inline bool is_number(std::string_view word) {
  float number = 0.0F;
  const char* end = word.data() + word.size();
  return !word.empty() && scan_float(word.data(), end, number) == end && std::isfinite(number);
}

}  // namespace hyades::core
