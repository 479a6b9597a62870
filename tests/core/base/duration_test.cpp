#include "core/base/duration.h"

#include <gtest/gtest.h>

#include <string>

namespace hyades::core {
namespace {

TEST(Duration, NumbersWithUnitsAddUp) {
  const auto seconds = [](const char* text) {
    const auto parsed = parse_duration(text);
    return parsed ? *parsed : -1.0;
  };
  EXPECT_EQ(seconds("0"), 0);
  EXPECT_EQ(seconds("90"), 90);
  EXPECT_EQ(seconds("2.5"), 2.5);
  EXPECT_EQ(seconds("90s"), 90);
  EXPECT_EQ(seconds("0.5s"), 0.5);
  EXPECT_EQ(seconds("5m"), 300);
  EXPECT_EQ(seconds("1.5h"), 5400);
  EXPECT_EQ(seconds("30d"), 30 * 86400);
  EXPECT_EQ(seconds("1h30m"), 5400);
  EXPECT_EQ(seconds("1d2h3m4s"), 86400 + 7200 + 180 + 4);
}

TEST(Duration, AnythingElseIsRefusedAndToldWhatWasExpected) {
  for (const char* text : {"",
                           "m",
                           "5x",
                           "5 m",
                           " 5m",
                           "5m ",
                           "-5m",
                           "-0",
                           "nan",
                           "inf",
                           "1e3",
                           "5m5",
                           "30m1h",
                           "5m5m",
                           "1s2s",
                           "5mm",
                           "0x10",
                           "400000d",
                           "1000d999999999d",
                           "5M",
                           "5min"}) {
    const auto parsed = parse_duration(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_NE(parsed.error().message.find("expected a length of time such as"), std::string::npos);
  }
  const auto zeros = parse_duration(std::string(400, '9'));
  EXPECT_FALSE(zeros);
}

}  // namespace
}  // namespace hyades::core
