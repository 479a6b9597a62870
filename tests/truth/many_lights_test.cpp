// T14 by pictures: a town of ten thousand lamps has 2.5 times the error of a hamlet of ten.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/random.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

/// `count` small balls over a square with one for each square metre, some of them behind walls.
std::string lamps(int count, double side, Random& random) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double x = (static_cast<double>(random.uniform()) - 0.5) * side;
    const double z = (static_cast<double>(random.uniform()) - 0.5) * side;
    const std::string name = std::to_string(i);
    const std::string place = std::to_string(x) + ", ";
    const auto height = std::to_string(0.3 + static_cast<double>(random.uniform()));
    const auto power = std::to_string(0.2 + static_cast<double>(random.uniform()));
    text += "      lamp_" + name + ": {shape: sphere, radius: 0.02, at: [" + place + height + ", " +
            std::to_string(z) + "], emit: {power: " + power + "}, visible_to_camera: false}\n";
    if (i % 3 != 0) continue;
    text += "      wall_" + name + ": {shape: box, size: [0.3, 0.3, 0.05], at: [" + place +
            "0.15, " + std::to_string(z + 0.2) + "], visible_to_camera: false}\n";
  }
  return text;
}

/// Ten square metres in the middle of the lamps, from above, lit directly.
YamlScene town(int count, const std::string& sky) {
  Random random(5);
  const bool hamlet = count <= 100;
  std::string text = R"(hyades: 1
film: {size: [24, 24], filter: box}
sampling: {samples: 16}
integrator: {type: path, max_depth: 1}
camera: {type: orthographic, look_from: [0, 9, 0], look_at: [0, 0, 0], up: [0, 0, -1], height: 3.16}
groups:
  block:
    objects:
)" + lamps(hamlet ? count : 100, hamlet ? std::sqrt(count) : 10.0, random) +
                     "objects:\n  ground: {shape: rectangle, size: [400, 400]}\n";
  const int blocks = hamlet ? 1 : count / 100;
  const int across = static_cast<int>(std::lround(std::sqrt(blocks)));
  for (int i = 0; i < blocks; ++i) {
    const double x = 10.0 * (i % across - 0.5 * (across - 1));
    const double z = 10.0 * (i / across - 0.5 * (across - 1));
    text += "  block_" + std::to_string(i) +
            ": {instance: block, transform: [{rotate_y: " + std::to_string(90 * (i % 4)) +
            "}], at: [" + std::to_string(x) + ", 0, " + std::to_string(z) + "]}\n";
  }
  return YamlScene(text + sky);
}

/// Standard deviation over mean of the picture's parts, root mean square.
double relative_error(const YamlScene& scene) {
  const Replicates runs = render_replicates(scene, 16, 2);
  double sum = 0.0;
  for (const auto& block : runs.blocks) sum += block[1].variance() / std::pow(block[1].mean(), 2);
  return std::sqrt(sum / static_cast<double>(runs.blocks.size()));
}

// The same seeds give the same bits, and so the same ratio: 2.52 without a sky and 2.46 with one.
// Lamps chosen evenly would make it some 30, the root of a thousand.
constexpr double kMostOfTen = 2.8;

TEST(ManyLights, TenThousandHaveLessThanThreeTimesTheErrorOfTen) {
  const double ten = relative_error(town(10, ""));
  const double ten_thousand = relative_error(town(10'000, ""));
  RecordProperty("error_of_ten", std::to_string(ten));
  RecordProperty("error_of_ten_thousand", std::to_string(ten_thousand));
  EXPECT_LT(ten_thousand / ten, kMostOfTen);
}

TEST(ManyLights, UnderAFaintSkyTooTenThousandHaveLessThanThreeTimesTheErrorOfTen) {
  const std::string sky = "environment: {color: 0.001}\n";
  const double ten = relative_error(town(10, sky));
  const double ten_thousand = relative_error(town(10'000, sky));
  RecordProperty("error_of_ten", std::to_string(ten));
  RecordProperty("error_of_ten_thousand", std::to_string(ten_thousand));
  EXPECT_LT(ten_thousand / ten, kMostOfTen);
}

}  // namespace
}  // namespace hyades::test
