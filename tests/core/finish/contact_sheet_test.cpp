#include "core/finish/contact_sheet.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/color.h"

namespace hyades::core {
namespace {

ContactPrint print(const std::string& name, int width, int height, const Rgb& color) {
  ContactPrint out{name, make_image(width, height, {"R", "G", "B"})};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) out.picture.at(x, y, c) = color[c];
    }
  }
  return out;
}

TEST(ContactSheet, PicturesOfARowAreEquallyHighAndFillIt) {
  const std::vector<ContactPrint> prints = {print("wide", 200, 100, {1.0F, 0.0F, 0.0F}),
                                            print("square", 100, 100, {0.0F, 0.5F, 0.0F}),
                                            print("wide too", 50, 25, {0.0F, 0.0F, 1.0F})};
  const auto sheet = contact_sheet(prints, 2, 100);
  ASSERT_TRUE(sheet) << sheet.error().message;
  EXPECT_EQ(sheet->width, 8 + 2 * 108);
  // Two to one and a square in 208 pixels less the gap of 8: 133.3 and 66.7 wide, 66.7 high.
  EXPECT_EQ(sheet->at(8, 8, 0), 1.0F);
  EXPECT_EQ(sheet->at(140, 74, 0), 1.0F);
  EXPECT_LT(sheet->at(145, 40, 0), 0.2F) << "the gap";
  EXPECT_NEAR(sheet->at(215, 74, 1), srgb_encode(0.5F), 1e-5F) << "the row ends at the margin";
  EXPECT_LT(sheet->at(216, 40, 1), 0.2F) << "the margin";
  EXPECT_LT(sheet->at(140, 75, 0), 0.2F) << "below the row";
  // The third stands alone in a row of the height that was wanted, two pictures a row: 200 pixels
  // for two of the mean shape, 5 to 3.
  const int second_row = 8 + 67 + 22 + 8;
  EXPECT_EQ(sheet->at(8, second_row, 2), 1.0F);
  EXPECT_EQ(sheet->at(127, second_row + 59, 2), 1.0F);
  EXPECT_LT(sheet->at(128, second_row, 2), 0.2F) << "it does not grow to fill its row";
  EXPECT_EQ(sheet->height, second_row + 60 + 22 + 8);
}

TEST(ContactSheet, NamesArePrinted) {
  const auto ink = [](const std::string& name) {
    const std::vector<ContactPrint> prints = {print(name, 100, 50, Rgb(0.0F))};
    const auto sheet = contact_sheet(prints, 1, 100);
    int dots = 0;
    for (int y = 58; y < sheet->height; ++y) {
      for (int x = 0; x < sheet->width; ++x) dots += sheet->at(x, y, 0) > 0.5F ? 1 : 0;
    }
    return dots;
  };
  EXPECT_EQ(ink(""), 0);
  EXPECT_EQ(ink("l"), 4 * 11);  // a stroke of seven dots and a foot of four, each 2 x 2
  EXPECT_EQ(ink("L"), ink("l"));
  EXPECT_EQ(ink("ll"), 2 * ink("l"));
  EXPECT_EQ(ink("llllllllllllllllllllllll"), ink("...lllll")) << "what does not fit is left out";
}

TEST(ContactSheet, LongNamesKeepTheirEnd) {
  const auto sheet_of = [](const std::string& name) {
    return contact_sheet(std::vector{print(name, 100, 100, {0.0F, 0.0F, 0.0F})}, 1, 100)->data;
  };
  const std::string shot = "a_very_long_name_of_a_shot.";
  EXPECT_NE(sheet_of(shot + "0001"), sheet_of(shot + "0002"));
  EXPECT_EQ(sheet_of("another" + shot + "0001"), sheet_of("the" + shot + "0001"));
}

TEST(ContactSheet, RefusesWhatItCannotShow) {
  EXPECT_FALSE(contact_sheet({}, 4, 100));
  const std::vector<ContactPrint> prints = {{"grey", make_image(4, 4, {"Y"})}};
  const auto sheet = contact_sheet(prints, 4, 100);
  ASSERT_FALSE(sheet);
  EXPECT_EQ(sheet.error().message, "grey: it has no channels R, G, B");
}

}  // namespace
}  // namespace hyades::core
