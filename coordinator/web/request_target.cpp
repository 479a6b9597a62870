#include "coordinator/web/request_target.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

/// Of what forms send, where a plus is a space.
std::optional<std::string> decode_form(std::string_view text) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), '+', ' ');
  return core::percent_decoded(spaced);
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
    auto name = core::percent_decoded(part);
    if (!name || !is_name(*name)) return std::nullopt;
    target.path.push_back(std::move(*name));
  }
  while (!query.empty()) {
    std::string_view value = take_until(query, '&');
    const auto name = decode_form(take_until(value, '='));
    auto decoded = decode_form(value);
    if (!name || !decoded) return std::nullopt;
    if (!name->empty()) target.query[*name] = std::move(*decoded);
  }
  return target;
}

}  // namespace hyades::coordinator
