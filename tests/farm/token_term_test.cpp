#include "farm/token_term.h"

#include <gtest/gtest.h>

namespace hyades::farm {
namespace {

constexpr int64_t kHour = 3'600'000;
constexpr int64_t kDay = 24 * kHour;
constexpr int64_t kMade = 1'700'000'000'000;  // 2023-11-14 22:13:20 UTC

TEST(TokenTerm, AYearsTokenIsToldOfInItsLastWeek) {
  const TokenTerm term = term_of(kMade, kMade + 365 * kDay);
  EXPECT_EQ(expiry_warning(term, term.expires_ms - 8 * kDay), "");
  EXPECT_EQ(expiry_warning(term, term.expires_ms - 3 * kDay),
            "expires on 2024-11-13 22:13 UTC, in 3 days");
  EXPECT_EQ(expiry_warning(term, term.expires_ms - 3 * kDay + 1),
            "expires on 2024-11-13 22:13 UTC, in 2 days");
  EXPECT_EQ(expiry_warning(term, term.expires_ms - kHour),
            "expires on 2024-11-13 22:13 UTC, in 1 hour");
}

TEST(TokenTerm, AnEveningsTokenIsNotToldOfAllEvening) {
  const TokenTerm term = term_of(kMade, kMade + 8 * kHour);
  EXPECT_EQ(expiry_warning(term, kMade + 1), "");
  EXPECT_NE(expiry_warning(term, term.expires_ms - kHour / 2).find("in 30 minutes"),
            std::string::npos);
}

TEST(TokenTerm, NothingIsToldOfOneThatNeverExpiresOrHasExpired) {
  EXPECT_EQ(expiry_warning(term_of(kMade, 0), kMade + 10'000 * kDay), "");
  const TokenTerm term = term_of(kMade, kMade + kDay);
  EXPECT_EQ(expiry_warning(term, term.expires_ms), "");
  // A clock that was set back while it was made.
  EXPECT_EQ(expiry_warning(term_of(kMade, kMade - 1), kMade - 2), "");
}

}  // namespace
}  // namespace hyades::farm
