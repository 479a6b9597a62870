#include "cli/status_line.h"

#include <string>

#include <gtest/gtest.h>

namespace hyades::cli {
namespace {

TEST(Fitted, TheBarGetsShorterBeforeAnythingIsCut) {
  EXPECT_EQ(fitted("a  ████████░░░░░░░░   50 %  1 min left", 40),
            "a  ████████░░░░░░░░   50 %  1 min left");
  EXPECT_EQ(fitted("a  ████████░░░░░░░░   50 %  1 min left", 30), "a  ████░░░░   50 %  1 min left");
  EXPECT_EQ(fitted("a  ████████░░░░░░░░   50 %  1 min left", 24), "a  50 %  1 min left");
}

TEST(Fitted, WhatIsTooLongWithoutABarIsCut) {
  EXPECT_EQ(fitted("a  ████████░░░░░░░░   50 %  1 min left", 10), "a  50 %  1");
  EXPECT_EQ(fitted("größer", 4), "größ");
  EXPECT_EQ(fitted("größer", 6), "größer");
  EXPECT_EQ(fitted("", 6), "");
}

}  // namespace
}  // namespace hyades::cli
