// What a film's layers hold, on scenes where that is known.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

const std::string kMirrorOverFloor = R"(
hyades: 1
name: layers
film: {size: [16, 16], filter: box}
sampling: {samples: 16}
camera: {look_from: [0, 1, 5], look_at: [0, 1, 0], fov: 20}
materials:
  tinted: {type: mirror, color: [0.9, 0.5, 0.2]}
  wall: {type: lambert, color: [0.4, 0.6, 0.8]}
objects:
  mirror: {shape: rectangle, size: [20, 20], transform: [{rotate_x: 90}], at: [0, 0, 0], material: tinted}
  wall: {shape: rectangle, size: [40, 40], transform: [{rotate_x: -90}], at: [0, 0, 8], material: wall}
environment: {color: 1}
)";

TEST(Layers, AlbedoIsSeenThroughMirrorsWithTheirTint) {
  const YamlScene scene(kMirrorOverFloor, 1, {.depth = true, .albedo = true, .normal = true});
  const core::Image picture = scene.render().film.normalised();
  const int albedo = picture.find_channel("albedo.R");
  EXPECT_NEAR(picture.at(8, 8, albedo), 0.9F * 0.4F, 1e-5F);
  EXPECT_NEAR(picture.at(8, 8, albedo + 1), 0.5F * 0.6F, 1e-5F);
  EXPECT_NEAR(picture.at(8, 8, albedo + 2), 0.2F * 0.8F, 1e-5F);
}

TEST(Layers, DepthNormalAndAlphaAreThoseOfTheFirstSurface) {
  const YamlScene scene(kMirrorOverFloor, 1, {.depth = true, .albedo = true, .normal = true});
  const core::Image picture = scene.render().film.normalised();
  EXPECT_NEAR(picture.at(3, 12, picture.find_channel("depth.Z")), 5.0F, 1e-4F);
  EXPECT_NEAR(picture.at(3, 12, picture.find_channel("normal.Z")), 1.0F, 1e-5F);
  EXPECT_EQ(picture.at(3, 12, picture.find_channel("A")), 1.0F);
}

// Layers come from camera rays, which are the same ones whatever brings the light.
TEST(Layers, AreThoseOfPathWhateverTheIntegrator) {
  const auto picture = [](const std::string& integrator) {
    const YamlScene scene(kMirrorOverFloor + R"(
integrator: )" + integrator + R"(
lights: {lamp: {type: point, at: [2, 3, 4], power: 100}}
)",
                          1, {.depth = true, .albedo = true, .normal = true});
    return scene.render().film.normalised();
  };
  const core::Image expected = picture("path");
  for (const char* integrator : {"bdpt", "mlt", "{type: mlt, over: path}"}) {
    SCOPED_TRACE(integrator);
    const core::Image found = picture(integrator);
    for (const char* layer :
         {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "A"}) {
      const int here = found.find_channel(layer);
      const int there = expected.find_channel(layer);
      ASSERT_TRUE(here >= 0 && there >= 0) << layer;
      for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
          ASSERT_EQ(found.at(x, y, here), expected.at(x, y, there))
              << layer << ' ' << x << ',' << y;
        }
      }
    }
  }
}

// Mitchell's filter has negative lobes, so its samples carry weights: single pixels scatter around
// the sky's 1 although every sample sees 1, and their mean is 1.
TEST(Layers, SamplesCarryTheWeightsOfTheirFilter) {
  const YamlScene scene(R"(
hyades: 1
name: weights
film: {size: [64, 64], filter: {type: mitchell, radius: 2}}
sampling: {samples: 16, sampler: independent}
objects: {}
environment: {color: 1}
)");
  const core::RenderedFrame frame = scene.render();
  const core::Image picture = frame.film.normalised();
  double squared = 0.0;
  double mean = 0.0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double value = static_cast<double>(picture.at(x, y, 0));
      mean += value / 4096.0;
      squared += (value - 1.0) * (value - 1.0) / 4096.0;
    }
  }
  EXPECT_GT(squared, 1e-4);
  EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt(squared / 4096.0));
}

TEST(Layers, AMovingBallIsSmearedOverItsWay) {
  const YamlScene scene(R"yaml(
hyades: 1
name: smear
frames: {range: 1-2, fps: 24, shutter: 1}
film: {size: [48, 16], filter: box}
sampling: {samples: 256}
camera: {look_from: [0, 0, 10], look_at: [0, 0, 0], fov: 20}
objects:
  ball: {shape: sphere, radius: 0.3, at: ["= -3 + 6 * (frame - 1)", 0, 0]}
)yaml");
  const core::Image picture = scene.render().film.normalised();
  // Coverage along the way is the ball's width over its way: the same everywhere between the ends.
  const float first = picture.at(14, 8, 3);
  const float middle = picture.at(24, 8, 3);
  EXPECT_NEAR(middle, 0.6F / 6.0F, 0.03F);
  EXPECT_NEAR(first, middle, 0.03F);
}

// One pixel is one unit in the plane z = 0; between the frames the plate moves two to the right and
// one up while the camera rises by three.
const std::string kMovingPlate = R"yaml(
hyades: 1
name: motion
frames: {range: 1-3, fps: 24}
film: {size: [16, 8], filter: box}
sampling: {samples: 4}
camera:
  look_from: [0, "= 3 * (frame - 2)", 10]
  look_at: [0, "= 3 * (frame - 2)", 0]
  fov: 43.602819
objects:
  plate: {shape: rectangle, size: [8, 90], transform: [{rotate_x: 90}], at: ["= -4 + 2 * (frame - 2)", "= frame", 0]}
outputs: [{file: a.####.exr, layers: [motion]}]
)yaml";

TEST(Layers, MotionLeadsToTheNextFrame) {
  const YamlScene scene(kMovingPlate, 2, {.motion = true});
  const core::Image picture = scene.render().film.normalised();
  const int u = picture.find_channel("forward.u");
  const int v = picture.find_channel("forward.v");
  ASSERT_TRUE(u >= 0 && v >= 0);
  EXPECT_NEAR(picture.at(3, 5, u), 2.0F, 1e-3F);
  EXPECT_NEAR(picture.at(3, 5, v), 1.0F - 3.0F, 1e-3F);
  // Infinitely far away nothing is seen of how the camera moves.
  EXPECT_NEAR(picture.at(12, 5, u), 0.0F, 1e-3F);
  EXPECT_NEAR(picture.at(12, 5, v), 0.0F, 1e-3F);
}

TEST(Layers, MotionIsThatFromOpeningToOpeningWhateverTheShutter) {
  std::string text = kMovingPlate;
  text.replace(text.find("fps: 24"), 7, "fps: 24, shutter: 0.5");
  const YamlScene scene(text, 2, {.motion = true});
  const core::Image picture = scene.render().film.normalised();
  EXPECT_NEAR(picture.at(3, 5, picture.find_channel("forward.u")), 2.0F, 1e-3F);
  EXPECT_NEAR(picture.at(3, 5, picture.find_channel("forward.v")), -2.0F, 1e-3F);
}

TEST(Layers, PositionIsThatOfTheFirstSurface) {
  for (const char* integrator : {"path", "bdpt", "mlt"}) {
    std::string text = kMovingPlate;
    text += std::string("integrator: {type: ") + integrator + "}\n";
    const YamlScene scene(text, 2, {.position = true});
    const core::Image picture = scene.render().film.normalised();
    const int x = picture.find_channel("position.X");
    EXPECT_NEAR(picture.at(3, 5, x), -4.5F, 0.2F) << integrator;
    EXPECT_NEAR(picture.at(3, 5, x + 1), -1.5F, 0.2F) << integrator;
    EXPECT_NEAR(picture.at(3, 5, x + 2), 0.0F, 1e-4F) << integrator;
    EXPECT_EQ(picture.at(12, 5, x), 0.0F) << integrator;
  }
}

}  // namespace
}  // namespace hyades::test
