#include "coordinator/web/request_target.h"

#include <cstddef>
#include <utility>

namespace hyades::coordinator {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_space) {
      decoded += ' ';
    } else if (text[i] != '%') {
      decoded += text[i];
    } else {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]);
      const int low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return decoded;
}

/// The text up to `end`, which is taken off together with it.
std::string_view take_until(std::string_view& text, char end) {
  const size_t at = text.find(end);
  const std::string_view part = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
  return part;
}

bool is_name(const std::string& part) {
  return part != "." && part != ".." && part.find('\0') == std::string::npos;
}

}  // namespace

std::optional<Target> parse_target(std::string_view text) {
  if (!text.starts_with('/')) return std::nullopt;
  std::string_view query = text.substr(0, text.find('#'));
  std::string_view path = take_until(query, '?');
  Target target;
  while (!path.empty()) {
    const std::string_view part = take_until(path, '/');
    if (part.empty()) continue;
    auto name = decode(part, false);
    if (!name || !is_name(*name)) return std::nullopt;
    target.path.push_back(std::move(*name));
  }
  while (!query.empty()) {
    std::string_view value = take_until(query, '&');
    const auto name = decode(take_until(value, '='), true);
    auto decoded = decode(value, true);
    if (!name || !decoded) return std::nullopt;
    if (!name->empty()) target.query[*name] = std::move(*decoded);
  }
  return target;
}

}  // namespace hyades::coordinator
