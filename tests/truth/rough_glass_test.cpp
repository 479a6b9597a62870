// Rough glass that gives back what its facets throw onto each other keeps all light.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/means.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

/// A ball of rough glass under a sky of one colour, which hides it if it keeps all light. It fills
/// the picture.
YamlScene ball(const std::string& glass, const std::string& interior, int samples) {
  return YamlScene(R"(
hyades: 1
name: rough ball
film: {size: [32, 32], filter: box}
sampling: {samples: )" +
                   std::to_string(samples) + R"(, seed: 3, sampler: independent}
integrator: {type: path, max_depth: 4000}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 18}
materials: {glass: {type: dielectric, )" +
                   glass + R"(}}
media: {white: {scattering: 5}}
objects: {ball: {shape: sphere, radius: 0.95, material: glass)" +
                   interior + R"(}}
environment: {color: 1}
)");
}

/// An error of one percent of any ball is noticed with 99 %.
const Promise kRoughGlassPromise{.tests = 15};

TEST(RoughGlass, VanishesUnderAUniformSky) {
  expect_picture_mean(ball("ior: 1.5, roughness: 0.3", "", 64), core::Vec3d(1.0),
                      kRoughGlassPromise);
  expect_picture_mean(ball("ior: 1.5, roughness: 0.6", "", 256), core::Vec3d(1.0),
                      kRoughGlassPromise);
  expect_picture_mean(ball("ior: 1.5, roughness: 1", "", 512), core::Vec3d(1.0),
                      kRoughGlassPromise);
  expect_picture_mean(ball("ior: 0.8, roughness: 0.7", "", 256), core::Vec3d(1.0),
                      kRoughGlassPromise);
  const PictureMean smooth = picture_mean(ball("ior: 1.5", "", 16).render().film);
  EXPECT_NEAR(smooth.mean[0], 1.0, 1e-5);
}

// Light in a white medium meets the surface from within many times before it is let out.
TEST(RoughGlass, VanishesAroundAWhiteMedium) {
  expect_picture_mean(ball("ior: 1.5, roughness: 0.6", ", interior: white", 256), core::Vec3d(1.0),
                      kRoughGlassPromise);
}

// Where indices are equal there is nothing to be seen, however rough: every path brings 1.
TEST(RoughGlass, OfEqualIndexIsNotThere) {
  const PictureMean seen =
      picture_mean(ball("ior: 1, roughness: 0.6", ", interior: white", 16).render().film);
  EXPECT_NEAR(seen.mean[0], 1.0, 1e-5);
  EXPECT_LT(seen.sigma[0], 1e-5);
}

TEST(RoughGlass, DarkensWithoutMultipleScattering) {
  const PictureMean seen = picture_mean(
      ball("ior: 1.5, roughness: 0.6, multiple_scattering: false", "", 64).render().film);
  EXPECT_LT(seen.mean[0], 0.92);
}

}  // namespace
}  // namespace hyades::test
