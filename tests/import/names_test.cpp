#include "import/names.h"

#include <gtest/gtest.h>

#include "core/job/read_values.h"
#include "import/within_folder.h"

namespace hyades::core {
namespace {

TEST(Names, OfFilesNeitherHideNorLeadOut) {
  EXPECT_EQ(safe_name("../../etc/passwd", "x"), "_.._etc_passwd");
  EXPECT_EQ(safe_name("...", "x"), "x");
  EXPECT_EQ(safe_name("-rf", "x"), "rf");
  EXPECT_EQ(safe_name("Brushed Metal.png", "x"), "Brushed_Metal.png");
  EXPECT_EQ(safe_name(std::string(500, 'a'), "x").size(), 60U);
}

TEST(Names, AreThoseOfTheJobLanguageAndDifferent) {
  Names names("thing");
  EXPECT_EQ(names.add("Körper 1"), "K_rper 1");
  EXPECT_EQ(names.add("a/b"), "a_b");
  EXPECT_EQ(names.add("a_b"), "a_b-2");
  EXPECT_EQ(names.add("a_b-2"), "a_b-2-2");
  EXPECT_EQ(names.add(""), "thing");
  EXPECT_EQ(names.add("  "), "thing-2");
  EXPECT_EQ(names.add(".hidden "), "_.hidden");
  for (const char* colour : {"12", "1e3", "3200K"}) {
    EXPECT_EQ(names.add(colour), std::string("thing-") + colour);
  }
  for (const std::string& odd :
       {std::string(500, 'a'), std::string("-"), std::string("\xff\x01")}) {
    EXPECT_TRUE(is_valid_name(names.add(odd))) << odd;
    EXPECT_TRUE(is_valid_name(names.add(odd))) << odd;
  }
}

TEST(Names, HaveThePrefixBeforeThem) {
  Names names("thing", "robot");
  EXPECT_EQ(names.add("Skin"), "robot.Skin");
  EXPECT_EQ(names.add("Skin"), "robot.Skin-2");
  EXPECT_EQ(Names("thing", "1").add("5"), "1.thing-5") << "1.5 would read as a number";
  EXPECT_TRUE(is_valid_name(Names("thing", std::string(60, 'p')).add(std::string(60, 'a'))));
}

TEST(Names, OfAHundredThousandThingsTakeLinearTime) {
  // What takes the square of their number takes minutes.
  Names many("mesh");
  for (int i = 1; i < 100'000; ++i) many.add("Mesh");
  EXPECT_EQ(many.add("Mesh"), "Mesh-100000");
}

TEST(WithinFolder, KeepsToTheFolderOfTheScene) {
  EXPECT_EQ(*within_folder("a/../b.png"), "b.png");
  EXPECT_EQ(*within_folder("./deep/er/x"), "deep/er/x");
  EXPECT_EQ(*within_folder("..almost"), "..almost");
  EXPECT_EQ(*within_folder("in/12:30.png"), "in/12:30.png");
  for (const char* out : {"..", "../x", "a/../../x", "a/b/../../..", "/etc/passwd", "//x", "C:/x",
                          "http://x/y", "file:x", "", "a\nb", "a\x7f"}) {
    EXPECT_FALSE(within_folder(out)) << out;
  }
  EXPECT_FALSE(within_folder(std::string("a\0b", 3)));
  EXPECT_LT(within_folder("/" + std::string(100'000, 'a')).error().message.size(), 300U);
}

}  // namespace
}  // namespace hyades::core
