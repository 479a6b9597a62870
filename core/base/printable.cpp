#include "core/base/printable.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "core/base/text.h"

namespace hyades::core {
namespace {

struct CodePoints {
  uint32_t first;
  uint32_t last;
};

constexpr CodePoints kDeceiving[] = {
    {0x0000, 0x001F}, {0x007F, 0x009F}, {0x00AD, 0x00AD},  {0x061C, 0x061C}, {0x180E, 0x180E},
    {0x200B, 0x200B}, {0x200E, 0x200F}, {0x2028, 0x202E},  {0x2060, 0x2064}, {0x2066, 0x2069},
    {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}, {0xE0000, 0xE007F}};

/// The first character of a text, and how many bytes it has; 0 bytes: it is not UTF-8.
struct Character {
  uint32_t code = 0;
  size_t bytes = 0;

  bool is_printable() const {
    return bytes != 0 && std::none_of(std::begin(kDeceiving), std::end(kDeceiving),
                                      [this](const CodePoints& range) {
                                        return code >= range.first && code <= range.last;
                                      });
  }
};

Character first_of(std::string_view text) {
  const size_t bytes = utf8_length(text);
  if (bytes == 0) return {};
  // The head of a character of n > 1 bytes has 7 - n bits of its code, each other byte has 6.
  const auto head = static_cast<uint8_t>(text[0]);
  uint32_t code = bytes == 1 ? head : head & (0x7FU >> bytes);
  for (size_t i = 1; i < bytes; ++i) code = code << 6U | (static_cast<uint8_t>(text[i]) & 0x3FU);
  return {code, bytes};
}

}  // namespace

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const Character first = first_of(text);
    if (!first.is_printable()) return false;
    text.remove_prefix(first.bytes);
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const Character first = first_of(text);
    const size_t taken = std::max<size_t>(first.bytes, 1);
    if (first.is_printable()) {
      clean += text.substr(0, taken);
    } else {
      clean += '?';
    }
    text.remove_prefix(taken);
  }
  return clean;
}

std::string printable_lines(std::string_view text) {
  std::string clean;
  for (size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    clean += printable(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return clean + printable(text);
}

}  // namespace hyades::core
