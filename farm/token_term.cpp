#include "farm/token_term.h"
#include "core/base/text.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace hyades::farm {
namespace {

constexpr int64_t kMinute = 60'000;
constexpr int64_t kHour = 60 * kMinute;
constexpr int64_t kDay = 24 * kHour;
constexpr int64_t kLongestWarning = 7 * kDay;
constexpr int64_t kShareTold = 8;

/// "3 days", "1 hour": never more than there is.
std::string in_words(int64_t ms) {
  const auto [unit, word] = ms >= 2 * kDay ? std::pair(kDay, "day")
                            : ms >= kHour  ? std::pair(kHour, "hour")
                                           : std::pair(kMinute, "minute");
  return core::counted(static_cast<uint64_t>(ms / unit), word);
}

}  // namespace

TokenTerm term_of(int64_t created_ms, int64_t expires_ms) {
  if (expires_ms == 0) return {};
  const int64_t lifetime = std::max<int64_t>(0, expires_ms - created_ms);
  return {expires_ms, expires_ms - std::min(kLongestWarning, lifetime / kShareTold)};
}

std::string expiry_warning(const TokenTerm& term, int64_t now_ms) {
  if (term.expires_ms == 0 || now_ms < term.warn_ms || now_ms >= term.expires_ms) return {};
  const std::chrono::system_clock::time_point when{std::chrono::milliseconds(term.expires_ms)};
  return fmt::format("expires on {:%Y-%m-%d %H:%M} UTC, in {}", when,
                     in_words(term.expires_ms - now_ms));
}

}  // namespace hyades::farm
