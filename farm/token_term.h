#pragma once

#include <cstdint>
#include <string>

namespace hyades::farm {

/// How long a token holds, and from when on its bearer should hear that it ends. Milliseconds since
/// 1970, UTC.
struct TokenTerm {
  int64_t expires_ms = 0;  ///< 0: never
  int64_t warn_ms = 0;     ///< of no meaning where it never expires
};

/// Told are the last eighth of a token's time, and at most its last seven days.
TokenTerm term_of(int64_t created_ms, int64_t expires_ms);

/// "expires on 2026-03-01 12:00 UTC, in 3 days"; empty where that is not worth a word yet.
std::string expiry_warning(const TokenTerm& term, int64_t now_ms);

}  // namespace hyades::farm
