#include "core/finish/sheet_rows.h"

#include <gtest/gtest.h>

#include <vector>

namespace hyades::core {
namespace {

std::vector<size_t> counts(const std::vector<SheetRow>& rows) {
  std::vector<size_t> out;
  for (const SheetRow& row : rows) out.push_back(row.end - row.first);
  return out;
}

TEST(SheetRows, PicturesOfOneShapeMakeAGrid) {
  for (const size_t last : {1U, 2U, 3U, 4U}) {
    const std::vector<double> aspects(8 + last, 1.5);
    const auto rows = sheet_rows(aspects, 4, 4 * 150 + 3 * 10, 10);
    EXPECT_EQ(counts(rows), (std::vector<size_t>{4, 4, last}));
    for (const SheetRow& row : rows) EXPECT_NEAR(row.height, 100.0, 1e-9);
  }
}

TEST(SheetRows, RowsOfMixedShapesFillTheWidth) {
  const std::vector<double> aspects = {1.78, 2.3, 1.0,  1.6, 1.33, 2.0,
                                       1.78, 1.0, 2.29, 1.6, 2.0,  1.78};
  const auto rows = sheet_rows(aspects, 4, 1000, 8);
  size_t next = 0;
  for (const SheetRow& row : rows) {
    EXPECT_EQ(row.first, next) << "in their order, each once";
    next = row.end;
    double width = 8.0 * static_cast<double>(row.end - row.first - 1);
    for (size_t i = row.first; i < row.end; ++i) width += aspects[i] * row.height;
    EXPECT_NEAR(width, 1000.0, 1e-6);
    EXPECT_GT(row.height, 110.0) << "four of the mean shape would be 143 high";
    EXPECT_LT(row.height, 180.0);
  }
  EXPECT_EQ(next, aspects.size());
}

TEST(SheetRows, NothingMakesNoRow) { EXPECT_TRUE(sheet_rows({}, 3, 100, 8).empty()); }

}  // namespace
}  // namespace hyades::core
