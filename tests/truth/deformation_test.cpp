// Meshes that deform while the shutter is open, in pictures.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

/// A box of 12 triangles between two corners.
std::string box(const core::Vec3& low, const core::Vec3& high) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string((i & 1) != 0 ? high.x : low.x) + " " +
            std::to_string((i & 2) != 0 ? high.y : low.y) + " " +
            std::to_string((i & 4) != 0 ? high.z : low.z) + "\n";
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// Two frames of a box that becomes wider and turns up, and of one that only moves.
class Deformation : public testing::Test {
 protected:
  Deformation() {
    write("swells.1.obj", box({-0.4F, 0.1F, -0.3F}, {0.1F, 0.5F, 0.2F}));
    write("swells.2.obj", box({-0.6F, 0.2F, -0.2F}, {0.8F, 0.9F, 0.3F}));
    write("lamp.1.obj", box({0.6F, 1.2F, 0.0F}, {0.8F, 1.3F, 0.4F}));
    write("lamp.2.obj", box({-0.5F, 1.4F, 0.0F}, {0.6F, 1.5F, 0.3F}));
    write("moves.1.obj", box({-0.5F, 0.1F, -0.3F}, {0.1F, 0.6F, 0.3F}));
    write("moves.2.obj", box({0.0F, 0.3F, -0.3F}, {0.6F, 0.8F, 0.3F}));
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
  }

  std::string path() const { return folder_.path().string(); }

  TempFolder folder_;
};

const std::string kScene = R"(
hyades: 1
frames: {range: 1-1, fps: 24, shutter: 0.9}
film: {size: [40, 30], filter: box}
camera: {look_from: [0, 1, 3], look_at: [0, 0.6, 0], fov: 45}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
)";

TEST_F(Deformation, AMeshThatIsCarriedAlongLooksLikeOneThatMoves) {
  const std::string around = kScene + R"(
sampling: {samples: 64, seed: 3}
environment: {color: 0.6}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  lamp: {shape: sphere, radius: 0.3, at: [1, 2, 1], emit: {radiance: 8}}
)";
  const YamlScene files(around + "  box: {mesh: moves.#.obj, material: white}\n", 1, {}, path());
  const YamlScene matrix(around +
                             "  box: {mesh: moves.1.obj, material: white, at: [\"= 0.5 * (frame - "
                             "1)\", \"= 0.2 * (frame - 1)\", 0]}\n",
                         1, {}, path());
  expect_same_picture(render_replicates(files, 12, 10), render_replicates(matrix, 12, 10),
                      {.tests = 3, .relative_error = 0.01});
}

TEST_F(Deformation, PathAndBdptAgree) {
  const std::string scene = kScene + R"(
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  box: {mesh: swells.#.obj, material: white}
  lamp: {mesh: lamp.#.obj, emit: {radiance: 6}}
)";
  const YamlScene path_scene(
      scene + "integrator: {type: path, max_depth: 5}\nsampling: {samples: 160}\n", 1, {}, path());
  const YamlScene bdpt_scene(
      scene + "integrator: {type: bdpt, max_depth: 5}\nsampling: {samples: 80}\n", 1, {}, path());
  expect_same_picture(render_replicates(path_scene, 16, 10), render_replicates(bdpt_scene, 16, 10),
                      {.tests = 3, .relative_error = 0.02});
}

// What a lamp gives off follows its area of the moment: the light that arrives far away is that of
// many still lamps between the two shapes.
TEST_F(Deformation, LampsShineWithTheAreaOfTheMoment) {
  write("sheet.1.obj", "v -0.1 2 -0.1\nv 0.1 2 -0.1\nv 0.1 2 0.1\nv -0.1 2 0.1\nf 1 2 3 4\n");
  write("sheet.2.obj", "v -0.5 2 -0.1\nv 0.5 2 -0.1\nv 0.5 2 0.1\nv -0.5 2 0.1\nf 1 2 3 4\n");
  const std::string floor = R"(
hyades: 1
frames: {range: 1-1, fps: 24, shutter: 1}
film: {size: [4, 4], filter: box}
camera: {look_from: [0, 1, 0.001], look_at: [0, 0, 0], fov: 3}
materials: {white: {type: lambert, color: 1}}
sampling: {samples: 4096}
integrator: {type: path, max_depth: 2}
objects:
  floor: {shape: rectangle, size: [1, 1], material: white}
)";
  const YamlScene scene(floor + "  lamp: {mesh: sheet.#.obj, emit: {radiance: 10}}\n", 1, {},
                        path());
  // The mean over time of the irradiance of strips of width w(t) = 0.2 + 0.8 t at height 2.
  double expected = 0.0;
  constexpr int kTimes = 200;
  constexpr int kCells = 40;
  for (int i = 0; i < kTimes; ++i) {
    const double width = 0.2 + 0.8 * (i + 0.5) / kTimes;
    for (int k = 0; k < kCells * kCells; ++k) {
      const double x = width * ((k % kCells + 0.5) / kCells - 0.5);
      const double z = 0.2 * ((k / kCells + 0.5) / kCells - 0.5);
      const double r2 = x * x + z * z + 4.0;
      expected += 4.0 / (r2 * r2) * width * 0.2 / (kCells * kCells);
    }
  }
  expected *= 10.0 / kTimes / 3.14159265358979;
  expect_picture_mean(scene, core::Vec3d(expected), {.tests = 3, .relative_error = 0.01});
}

TEST_F(Deformation, MotionFollowsTheVertices) {
  write("wall.1.obj", "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3 4\n");
  write("wall.2.obj", "v -4 -4 0\nv 8 -4 0\nv 8 4 0\nv -4 4 0\nf 1 2 3 4\n");
  const YamlScene scene(R"(
hyades: 1
frames: {range: 1-1, fps: 24, shutter: 0.5}
film: {size: [16, 8], filter: box}
sampling: {samples: 16}
camera: {look_from: [0, 0, 10], look_at: [0, 0, 0], fov: 43.602819}
objects: {wall: {mesh: wall.#.obj}}
outputs: [{file: a.####.exr, layers: [motion]}]
)",
                        1, {.motion = true}, path());
  const core::Image picture = scene.render().film.normalised();
  const int u = picture.find_channel("forward.u");
  ASSERT_GE(u, 0);
  // A place that starts at x goes by 4 (x + 4) / 8; one pixel is one unit. Seen in mid-shutter at
  // X it was at X - 4 s (x + 4) / 8 with s in 0..0.5: by 1 / (1 + s / 2) less far from -4.
  double expected = 0.0;
  for (int i = 0; i < 1000; ++i)
    expected += 0.5 * 3.5 / (1.0 + 0.5 * 0.5 * (i + 0.5) / 1000) / 1000;
  EXPECT_NEAR(static_cast<double>(picture.at(7, 4, u)), expected, 0.05);
  EXPECT_NEAR(static_cast<double>(picture.at(7, 4, u + 1)), 0.0, 1e-3);
}

}  // namespace
}  // namespace hyades::test
