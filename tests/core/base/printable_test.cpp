#include "core/base/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace hyades::core {
namespace {

TEST(Printable, WhatPeopleWriteStays) {
  for (const char* text : {"", "balls 7", "Müller's \u0416\u4E2D\U0001F600",
                           "\u0645\u06CC\u200C\u062E\u0648\u0627\u0647\u0645"}) {
    EXPECT_TRUE(is_printable(text)) << text;
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, WhatSteersTurnsOrHidesIsMarked) {
  for (const char* odd :
       {"\x1B", "\n", "\x7F", "\u0085", "\u009B", "\u2028", "\u2029", "\u202E", "\u2066", "\u200F",
        "\u061C", "\u200B", "\uFEFF", "\U000E0041", "\u00AD", "\xFF"}) {
    const std::string text = std::string("a") + odd + "b";
    EXPECT_FALSE(is_printable(text)) << text;
    EXPECT_EQ(printable(text), "a?b");
  }
  EXPECT_EQ(printable(std::string("\0\xE2\x80", 3)), "???");
}

}  // namespace
}  // namespace hyades::core
