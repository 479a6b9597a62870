#include "coordinator/web/sessions.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

TEST(Sessions, LastUntilTheirTimeOrTheirEnd) {
  Sessions sessions;
  const auto first = sessions.open("9f3a01c2", 1000);
  const auto second = sessions.open("9f3a01c2", 1000);
  ASSERT_TRUE(first && second);
  const std::string secret = first->secret;
  EXPECT_NE(secret, second->secret);
  ASSERT_TRUE(sessions.find(secret, 999));
  EXPECT_EQ(sessions.find(secret, 999)->token_id, "9f3a01c2");
  EXPECT_NE(sessions.find(secret, 999)->key, secret) << "the secret itself is handed to nobody";
  EXPECT_FALSE(sessions.find(secret, 1000));
  EXPECT_EQ(sessions.end(secret)->key.size(), 64U);
  EXPECT_FALSE(sessions.find(secret, 1));
  EXPECT_FALSE(sessions.end(secret));
  EXPECT_TRUE(sessions.find(second->secret, 1)) << "of the same person, in another browser";
  for (const std::string& wrong : {std::string(), std::string(64, '0'), second->secret + "0"}) {
    EXPECT_FALSE(sessions.find(wrong, 1)) << wrong;
  }
}

TEST(Sessions, ThereAreNeverMoreThanSoMany) {
  Sessions sessions;
  const std::string first = sessions.open("a", 5)->secret;
  const std::string last = sessions.open("a", 7)->secret;
  for (int i = 0; i < 10'000 - 2; ++i) {
    ASSERT_EQ(sessions.open(std::to_string(i / 100), 6)->ended, "") << i;
  }
  const std::string key = sessions.find(first, 1)->key;
  EXPECT_EQ(sessions.open("b", 6)->ended, key);
  EXPECT_FALSE(sessions.find(first, 1));
  EXPECT_TRUE(sessions.find(last, 1));
}

TEST(Sessions, OneTokenEndsItsOwnOldestAndNobodyElses) {
  Sessions sessions;
  const std::string others = sessions.open("other", 1)->secret;
  const std::string first = sessions.open("a", 9)->secret;
  const std::string second = sessions.open("a", 9)->secret;
  for (int i = 0; i < 98; ++i) ASSERT_EQ(sessions.open("a", 9)->ended, "") << i;
  const std::string key = sessions.find(first, 0)->key;
  EXPECT_EQ(sessions.open("a", 9)->ended, key) << "so that what is open in it can end";
  EXPECT_FALSE(sessions.find(first, 0));
  EXPECT_TRUE(sessions.find(second, 0));
  EXPECT_TRUE(sessions.find(others, 0));
}

}  // namespace
}  // namespace hyades::coordinator
