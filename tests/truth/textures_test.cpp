// What textures do to pictures: images seen from afar, and with any integrator.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/image/write_image.h"
#include "tests/support/temp_folder.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

/// A folder with board.png: 256 x 256 texels, squares of 8.
const std::string& folder_with_board() {
  static const TempFolder folder;
  static const std::string path = [] {
    core::Image board = core::make_image(256, 256, {"R", "G", "B"});
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const bool white = (x / 8 + y / 8) % 2 == 0;
        for (int c = 0; c < 3; ++c)
          board.at(x, y, c) = white ? 1.0F : 0.2F + 0.1F * static_cast<float>(c);
      }
    }
    EXPECT_TRUE(core::write_png(folder.file("board.png"), board).ok());
    return folder.path().string();
  }();
  return path;
}

/// A floor of boards to the horizon under an even sky.
YamlScene floor_to_the_horizon(const std::string& filter, int samples) {
  return YamlScene(
      "hyades: 1\nname: floor\nfilm: {size: [64, 36], filter: box}\nsampling: {samples: " +
          std::to_string(samples) + R"(, seed: 3}
camera: {look_from: [0, 1, 0], look_at: [0, 0.75, -5], fov: 40}
textures:
  board: {type: image, file: board.png, scale: 400, filter: )" +
          filter + R"(}
materials: {board: {type: lambert, color: board}}
objects: {floor: {shape: rectangle, size: [800, 800], material: board}}
environment: {color: 1}
)",
      1, {}, folder_with_board());
}

/// The squares by which the pixels of two pictures differ, below the horizon.
double difference(const core::Image& a, const core::Image& b) {
  double sum = 0.0;
  for (int y = 14; y < 24; ++y) {
    for (int x = 0; x < 64; ++x) sum += std::pow(double{a.at(x, y, 0)} - double{b.at(x, y, 0)}, 2);
  }
  return sum / (10 * 64);
}

double mean(const core::Image& a) {
  double sum = 0.0;
  for (int y = 14; y < 24; ++y) {
    for (int x = 0; x < 64; ++x) sum += double{a.at(x, y, 0)};
  }
  return sum / (10 * 64);
}

// With the same few samples the far floor has a fraction of the noise, and is as bright.
TEST(TexturePictures, ImagesSeenFromAfarAreQuietAndAsBright) {
  const core::Image truth = floor_to_the_horizon("bilinear", 1024).render().film.normalised();
  const double rough =
      difference(floor_to_the_horizon("bilinear", 4).render().film.normalised(), truth);
  EXPECT_GT(rough, 1e-3);
  for (const char* filter : {"trilinear", "anisotropic"}) {
    SCOPED_TRACE(filter);
    const core::Image seen = floor_to_the_horizon(filter, 4).render().film.normalised();
    EXPECT_LT(difference(seen, truth), 0.1 * rough);
    EXPECT_NEAR(mean(seen), mean(truth), 0.005 * mean(truth));
  }
}

}  // namespace
}  // namespace hyades::test
