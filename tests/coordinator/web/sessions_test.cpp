#include "coordinator/web/sessions.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

TEST(Sessions, LastUntilTheirTimeOrTheirEnd) {
  Sessions sessions;
  const auto first = sessions.open("9f3a01c2", 1000);
  const auto second = sessions.open("9f3a01c2", 1000);
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  ASSERT_TRUE(sessions.find(*first, 999));
  EXPECT_EQ(sessions.find(*first, 999)->token_id, "9f3a01c2");
  EXPECT_NE(sessions.find(*first, 999)->key, *first) << "the secret itself is handed to nobody";
  EXPECT_FALSE(sessions.find(*first, 1000));
  EXPECT_EQ(sessions.end(*first)->key.size(), 64U);
  EXPECT_FALSE(sessions.find(*first, 1));
  EXPECT_FALSE(sessions.end(*first));
  EXPECT_TRUE(sessions.find(*second, 1)) << "of the same person, in another browser";
  for (const std::string& wrong : {std::string(), std::string(64, '0'), *second + "0"}) {
    EXPECT_FALSE(sessions.find(wrong, 1)) << wrong;
  }
}

TEST(Sessions, ThereAreNeverMoreThanSoMany) {
  Sessions sessions;
  const auto first = sessions.open("a", 5);
  const auto last = sessions.open("a", 7);
  for (int i = 0; i < 10'000 - 1; ++i) ASSERT_TRUE(sessions.open("a", 6));
  EXPECT_FALSE(sessions.find(*first, 1));
  EXPECT_TRUE(sessions.find(*last, 1));
}

}  // namespace
}  // namespace hyades::coordinator
