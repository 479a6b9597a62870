#include "cli/client/finish_time.h"

#include <optional>

namespace hyades::cli {
namespace {

std::optional<std::tm> read(const std::string& text, const char* format, std::tm begin = {}) {
  const char* end = ::strptime(text.c_str(), format, &begin);
  if (end == nullptr || *end != '\0') return std::nullopt;
  begin.tm_isdst = -1;
  return begin;
}

}  // namespace

core::Result<std::time_t> parse_moment(const std::string& text, std::time_t now) {
  if (auto utc = read(text, "%Y-%m-%dT%H:%M:%SZ")) return ::timegm(&*utc);
  if (auto utc = read(text, "%Y-%m-%dT%H:%MZ")) return ::timegm(&*utc);
  if (auto local = read(text, "%Y-%m-%dT%H:%M")) return std::mktime(&*local);
  std::tm today{};
  ::localtime_r(&now, &today);
  today.tm_sec = 0;
  if (auto local = read(text, "%H:%M", today)) {
    std::tm next = *local;
    const std::time_t at = std::mktime(&*local);
    if (at > now) return at;
    ++next.tm_mday;
    next.tm_isdst = -1;
    return std::mktime(&next);
  }
  return core::Error{text +
                     ": expected a time such as 18:00, 2026-03-01T18:00 (local time) or "
                     "2026-03-01T18:00:00Z"};
}

}  // namespace hyades::cli
