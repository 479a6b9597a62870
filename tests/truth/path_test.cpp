// What must hold for every picture of the path integrator, whatever the scene.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/means.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

/// Moments of the means of `runs` renderings that differ by their seed only, of one channel over
/// the whole picture.
Moments over_seeds(const std::string& yaml, int runs, int channel = 0) {
  Moments moments;
  for (int run = 0; run < runs; ++run) {
    const YamlScene scene(yaml + "\nsampling: {samples: 16, sampler: independent, seed: " +
                          std::to_string(run + 1) + "}\n");
    moments.add(picture_mean(scene.render().film).mean[channel]);
  }
  return moments;
}

const std::string kRoom = R"(
hyades: 1
name: room
film: {size: [32, 32], filter: box}
camera: {look_from: [0, 1, 4.5], look_at: [0, 1, 0], fov: 35}
materials:
  white: {type: lambert, color: 0.8}
  black: {type: black}
objects:
  floor: {shape: rectangle, size: [2, 2], material: white}
  back: {shape: rectangle, size: [2, 2], material: white, transform: [{rotate_x: 90}], at: [0, 1, -1]}
  left: {shape: rectangle, size: [2, 2], material: white, transform: [{rotate_z: -90}], at: [-1, 1, 0]}
  right: {shape: rectangle, size: [2, 2], material: white, transform: [{rotate_z: 90}], at: [1, 1, 0]}
)";

const std::string kSquareLamp =
    "  lamp: {shape: sphere, radius: 0.2, at: [0.1, 1.4, 0], material: black, emit: {radiance: "
    "10}}\n";

// T5: clear glass adds and takes nothing: it cannot be seen against a sky of one colour.
TEST(Path, GlassVanishesUnderAUniformSky) {
  const std::string glass = R"(
hyades: 1
name: vanish
film: {size: [24, 24], filter: box}
integrator: {type: path, max_depth: 200}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 40}
materials:
  glass: {type: dielectric, ior: 1.6}
  thin: {type: thin-dielectric, ior: 1.4}
objects:
  ball: {shape: sphere, radius: 0.9, at: [-0.4, 0, 0], material: glass}
  block: {shape: box, size: [0.8, 0.9, 0.7], material: glass, at: [0.9, 0.9, 0.8], transform: [{rotate_y: 33}, {rotate_x: 20}]}
  pane: {shape: rectangle, size: [1, 1], material: thin, at: [0.6, -0.5, 2], transform: [{rotate_x: 70}]}
environment: {color: 1}
)";
  // Every path that leaves brings exactly 1 but for rounding, so there is next to no noise to hide
  // an error in.
  const Moments mean = over_seeds(glass, 12);
  EXPECT_NEAR(mean.mean(), 1.0, 1e-4);
  EXPECT_LT(mean.variance_of_mean(), 1e-10);
}

TEST(Path, RouletteDoesNotBias) {
  const auto with = [](const char* roulette) {
    return kRoom + kSquareLamp +
           "integrator: {type: path, max_depth: 64, roulette_depth: " + roulette + "}\n";
  };
  EXPECT_TRUE(means_agree(over_seeds(with("1"), 75), over_seeds(with("64"), 75)));
}

// The camera's rays, shadow rays and bounces all pass a null surface as if it were not there.
TEST(Path, NullSurfacesAreNotThere) {
  const std::string shell =
      "  shell: {shape: sphere, radius: 0.3, at: [0.1, 1.4, 0], material: nothing}\n"
      "  sheet: {shape: rectangle, size: [1.9, 1.9], at: [0, 0.7, 0], material: nothing}\n";
  std::string with_null = kRoom;
  with_null.insert(with_null.find("  black:"), "  nothing: {type: 'null'}\n");
  EXPECT_TRUE(means_agree(over_seeds(with_null + kSquareLamp + shell, 75),
                          over_seeds(kRoom + kSquareLamp, 75)));
}

// T14: how a light's power is spread over lights changes the noise, not the picture.
TEST(Path, SplitLightsGiveTheSamePicture) {
  const std::string halves =
      "  lamp: {shape: sphere, radius: 0.2, at: [0.1, 1.4, 0], material: black, emit: {radiance: "
      "10}}\n"
      "lights:\n"
      "  a: {type: point, at: [-0.5, 1.5, 0.5], power: 3}\n"
      "  b: {type: point, at: [-0.5, 1.5, 0.5], power: 9}\n";
  const std::string whole =
      "  lamp: {shape: sphere, radius: 0.2, at: [0.1, 1.4, 0], material: black, emit: {radiance: "
      "10}}\n"
      "lights:\n"
      "  a: {type: point, at: [-0.5, 1.5, 0.5], power: 12}\n";
  EXPECT_TRUE(means_agree(over_seeds(kRoom + halves, 75), over_seeds(kRoom + whole, 75)));
}

TEST(Path, DepthZeroShowsLightsOnly) {
  const YamlScene scene(kRoom + kSquareLamp +
                        "integrator: {type: path, max_depth: 0}\nsampling: {samples: 16}\n");
  const core::Image picture = scene.render().film.normalised();
  float brightest = 0.0F;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      brightest = std::max(brightest, picture.at(x, y, 0));
      if (picture.at(x, y, 0) > 0.0F) {
        EXPECT_LT(y, 16) << "only the lamp, in the upper half, may shine";
      }
    }
  }
  EXPECT_FLOAT_EQ(brightest, 10.0F);
}

TEST(Path, ADeeperLimitAddsLight) {
  double before = 0.0;
  for (const char* depth : {"0", "1", "2", "4"}) {
    const double mean =
        over_seeds(kRoom + kSquareLamp + "integrator: {type: path, max_depth: " + depth + "}\n", 4)
            .mean();
    EXPECT_GT(mean, before * 1.02) << depth;
    before = mean;
  }
}

TEST(Path, ClampingTakesLightAwayAndOnlyOnRequest) {
  const Moments exact = over_seeds(kRoom + kSquareLamp, 8);
  const Moments clamped =
      over_seeds(kRoom + kSquareLamp + "integrator: {type: path, clamp: 0.05}\n", 8);
  EXPECT_LT(clamped.mean(), 0.95 * exact.mean());
}

TEST(Path, AnInvisibleSkyLightsTheSceneAndIsBlackBehindIt) {
  const std::string yaml = R"(
hyades: 1
name: sky
film: {size: [16, 16], filter: box}
sampling: {samples: 64}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 60}
objects:
  ball: {shape: sphere, radius: 0.5}
environment: {color: 1, visible_to_camera: false}
)";
  const core::Image picture = YamlScene(yaml).render().film.normalised();
  EXPECT_EQ(picture.at(0, 0, 0), 0.0F);
  EXPECT_EQ(picture.at(0, 0, 3), 0.0F);
  EXPECT_NEAR(picture.at(8, 8, 0), 0.5F, 0.05F);  // albedo 0.5 under a sky of 1
  EXPECT_EQ(picture.at(8, 8, 3), 1.0F);
}

TEST(Path, AnEmptySceneIsBlackAndWhole) {
  const auto frame =
      YamlScene(
          "hyades: 1\nname: empty\nfilm: {size: [8, 8]}\nsampling: {samples: 4}\nobjects: {}\n")
          .render();
  EXPECT_EQ(frame.counters.bad_samples, 0U);
  EXPECT_EQ(picture_mean(frame.film).mean[0], 0.0);
}

TEST(Path, ZeroAreaLightsAndACameraInsideASphereRender) {
  const std::string yaml = R"(
hyades: 1
name: inside
film: {size: [8, 8]}
sampling: {samples: 16}
camera: {look_from: [0, 0, 0], look_at: [0, 0, -1], fov: 60}
objects:
  ball: {shape: sphere, radius: 3}
  flat: {shape: rectangle, size: [1, 1], transform: [{scale: [1, 1, 0.0000001]}], at: [0, 0, -2], emit: {radiance: 5}}
lights:
  lamp: {type: point, at: [0, 1, 0], power: 20}
)";
  const auto frame = YamlScene(yaml).render();
  EXPECT_EQ(frame.counters.bad_samples, 0U);
  EXPECT_GT(picture_mean(frame.film).mean[0], 0.0);
}

}  // namespace
}  // namespace hyades::test
