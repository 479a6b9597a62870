// Files of NanoVDB in a job, from its text to a film.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/film/film.h"
#include "tests/support/nanovdb_writer.h"
#include "tests/support/temp_folder.h"
#include "tests/support/vdb_writer.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

constexpr Promise kNanoVdbPromise{
    .significance = 0.01, .tests = 2, .relative_error = 0.01, .power = 0.99};

std::string job(const std::string& file, int samples, const std::string& camera,
                const std::string& medium) {
  return "hyades: 1\nname: smoke\nfilm: {size: [12, 12], filter: box}\nsampling: {samples: " +
         std::to_string(samples) +
         ", seed: 3, sampler: independent}\nintegrator: {type: path, max_depth: 8}\ncamera: {" +
         camera + R"(}
materials: {air: {type: "null"}}
media: {smoke: {)" +
         medium + ", density: {vdb: " + file + R"(, place: native}}}
objects: {body: {shape: box, size: [4, 4, 6], material: air, interior: smoke}}
environment: {color: [1, 2, 3]}
)";
}

openvdb::FloatGrid::Ptr gradient() {
  return vdb_box<openvdb::FloatGrid>("density", 12, 0.25, {-1.5, -1.5, -1.0},
                                     [](int, int, int k) { return k < 6 ? 0.5F : 1.0F; });
}

/// A ball that thins out from its middle.
openvdb::FloatGrid::Ptr ball() {
  return vdb_box<openvdb::FloatGrid>("density", 32, 0.1, {-1.6, -1.6, -1.6},
                                     [](int i, int j, int k) {
                                       const double x = i - 15.5;
                                       const double y = j - 15.5;
                                       const double z = k - 15.5;
                                       const double r = std::sqrt(x * x + y * y + z * z) / 15.5;
                                       return static_cast<float>(std::max(0.0, 1.0 - r));
                                     });
}

// Along an axis the integral of interpolated values is their sum.
TEST(NanoVdb, AbsorbsWhatItsNumbersSay) {
  TempFolder folder;
  std::ofstream(folder.file("smoke.nvdb"), std::ios::binary)
      << nanovdb_file({gradient()}, nanovdb::io::Codec::BLOSC);
  const double passed = 0.25 * (6 * 0.5 + 6 * 1.0);
  expect_picture_mean(
      YamlScene(job("smoke.nvdb", 14000, "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 0.01",
                    "absorption: [0.2, 0.5, 1]"),
                1, {}, folder.path().string()),
      {std::exp(-0.2 * passed), 2.0 * std::exp(-0.5 * passed), 3.0 * std::exp(-1.0 * passed)},
      kNanoVdbPromise);
}

// The same field in both kinds of files is the same picture, bit by bit.
TEST(NanoVdb, IsWhatTheSameVdbIs) {
  TempFolder folder;
  std::ofstream(folder.file("ball.nvdb"), std::ios::binary)
      << nanovdb_file({ball()}, nanovdb::io::Codec::ZIP);
  std::ofstream(folder.file("ball.vdb"), std::ios::binary) << vdb_file({ball()});
  const auto mean_of = [&](const char* file) {
    return picture_mean(YamlScene(job(file, 64, "look_from: [3, 2, 4], look_at: [0, 0, 0], fov: 40",
                                      "scattering: [3, 2, 1], absorption: 0.5, g: 0.3"),
                                  1, {}, folder.path().string())
                            .render()
                            .film);
  };
  const PictureMean vdb = mean_of("ball.vdb");
  const PictureMean nanovdb = mean_of("ball.nvdb");
  EXPECT_GT(vdb.sigma.x, 0.0);
  EXPECT_LT(vdb.mean.z, 2.9);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(vdb.mean[c], nanovdb.mean[c]);
    EXPECT_EQ(vdb.sigma[c], nanovdb.sigma[c]);
  }
}

}  // namespace
}  // namespace hyades::test
