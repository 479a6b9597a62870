// Files of strands.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>

#include "core/geometry/read_hair.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

StrandList three_strands() {
  StrandList list;
  for (int i = 0; i < 9; ++i) {
    const auto x = static_cast<float>(i);
    list.points.emplace_back(0.1F * x, x, -x);
    list.radii.push_back(0.125F + 0.5F * x);
    list.colors.emplace_back(0.1F * x, 0.5F, 1.0F);
  }
  list.sizes = {2, 4, 3};
  return list;
}

class ReadHair : public ::testing::Test {
 protected:
  Result<std::shared_ptr<const CurveSet>> read(const std::string& bytes, size_t room = 0) {
    std::ofstream(folder_.file("a.hair"), std::ios::binary) << bytes;
    const auto assets = make_file_resolver(folder_.path().string());
    return read_hair(*assets, "a.hair", CurveBasis::catmull_rom, room);
  }
  std::string complaint(const std::string& bytes, size_t room = 0) {
    const auto set = read(bytes, room);
    return set.ok() ? std::string() : set.error().message;
  }
  static std::string good() {
    const Bytes bytes = hair_bytes(three_strands());
    return {bytes.chars(), bytes.size()};
  }

  test::TempFolder folder_;
};

TEST_F(ReadHair, ReadsBackWhatWasWritten) {
  const auto set = read(good());
  ASSERT_TRUE(set.ok()) << set.error().message;
  const auto made = make_curve_set(three_strands(), CurveBasis::catmull_rom);
  ASSERT_TRUE(made.ok());
  EXPECT_EQ((*set)->points, (*made)->points);
  EXPECT_EQ((*set)->pieces, (*made)->pieces);
  EXPECT_EQ((*set)->strands, (*made)->strands);
  EXPECT_EQ((*set)->colors, (*made)->colors);
  EXPECT_EQ((*set)->strand_count(), 3U);
  EXPECT_EQ((*set)->name, "a.hair");
}

// The header's own numbers count for what has no array: 2 strands of 2 points, 0.5 thick, red.
TEST_F(ReadHair, TakesWhatIsTheSameEverywhereFromTheHeader) {
  std::string file(128, '\0');
  std::memcpy(file.data(), "HAIR", 4);
  const uint32_t numbers[] = {2, 4, 2, 1};  // strands, points, points only, segments
  std::memcpy(file.data() + 4, numbers, sizeof(numbers));
  const float more[] = {0.5F, 0.0F, 1.0F, 0.0F, 0.0F};
  std::memcpy(file.data() + 20, more, sizeof(more));
  const float points[] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0};
  file.append(reinterpret_cast<const char*>(points), sizeof(points));
  const auto set = read(file);
  ASSERT_TRUE(set.ok()) << set.error().message;
  EXPECT_EQ((*set)->strand_count(), 2U);
  EXPECT_EQ((*set)->points[0].w, 0.25F);
  EXPECT_EQ((*set)->colors[0], Vec3(1.0F, 0.0F, 0.0F));
}

TEST_F(ReadHair, TellsWhatIsWrong) {
  EXPECT_EQ(complaint("ply\n"),
            "a.hair: it is no file of strands; expected one that begins with HAIR");
  EXPECT_EQ(complaint("HAIR"), "a.hair: the file ends within its header");
  for (const size_t size : {128, 130, 140, 200, 300}) {
    EXPECT_EQ(complaint(good().substr(0, size)),
              "a.hair: the file is too short for 3 strands of 9 points")
        << size;
  }
  StrandList bright = three_strands();
  bright.colors[4].y = 255.0F;
  const Bytes codes = hair_bytes(bright);
  EXPECT_EQ(
      complaint({codes.chars(), codes.size()}),
      "a.hair: one of its colours is 255, expected 0 to 1; if they go from 0 to 255, divide by "
      "255");
  std::string no_points = good();
  no_points[12] = 1;
  EXPECT_EQ(complaint(no_points), "a.hair: it has no points");
  std::string other_sum = good();
  other_sum[128] = 2;
  EXPECT_EQ(complaint(other_sum), "a.hair: its strands have 10 points in all, but it says 9");
  std::string many = good();
  many[7] = 100;
  EXPECT_EQ(complaint(many), "a.hair: the file is too short for 1677721603 strands of 9 points");
  EXPECT_EQ(complaint(good(), 1 << 10),
            "a.hair: 9 points of strands take about 0 MB, but there are 0 MB only");
}

}  // namespace
}  // namespace hyades::core
