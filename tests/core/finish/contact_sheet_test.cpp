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

TEST(ContactSheet, ScalesPicturesAndPutsThemIntoRows) {
  const std::vector<ContactPrint> prints = {print("one", 200, 100, {1.0F, 0.0F, 0.0F}),
                                            print("two", 100, 100, {0.0F, 0.5F, 0.0F}),
                                            print("three", 50, 25, {0.0F, 0.0F, 1.0F})};
  const auto sheet = contact_sheet(prints, 2, 100);
  ASSERT_TRUE(sheet) << sheet.error().message;
  EXPECT_EQ(sheet->width, 8 + 2 * 108);
  EXPECT_EQ(sheet->at(58, 33, 0), 1.0F);
  EXPECT_NEAR(sheet->at(166, 100, 1), srgb_encode(0.5F), 1e-5F) << "as high as it is wide";
  EXPECT_LT(sheet->at(58, 100, 0), 0.2F) << "half as high as wide";
  // The second row begins below the highest picture of the first and its name.
  const int second_row = 8 + 100 + 22 + 8;
  EXPECT_EQ(sheet->at(58, second_row + 25, 2), 1.0F);
  EXPECT_LT(sheet->at(166, second_row + 25, 2), 0.2F);
  EXPECT_EQ(sheet->height, second_row + 50 + 22 + 8);
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
  EXPECT_EQ(ink("llllllllllllllllllllllll"), 8 * ink("l")) << "what does not fit is left out";
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
