// Defects that a renderer of media elsewhere has, and that this one must not have (docs/testing.md
// lists them all, with the tests that stand elsewhere).

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/quadrature.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

constexpr Promise kDefectsPromise{
    .significance = 0.01, .tests = 8, .relative_error = 0.01, .power = 0.99};

/// Every pixel looks from (0, 0, 4) along -z.
std::string defect_job(int samples, int max_depth, const std::string& rest) {
  return R"(
hyades: 1
film: {size: [12, 12], filter: box}
sampling: {samples: )" +
         std::to_string(samples) + R"(, seed: 9, sampler: independent}
integrator: {type: path, max_depth: )" +
         std::to_string(max_depth) + R"(, roulette_depth: 64}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 0.01}
materials: {air: {type: "null"}, clear: {type: dielectric, ior: 1}, glass: {type: dielectric}, black: {type: black}}
)" + rest;
}

double henyey_greenstein(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * M_PI * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

/// Light of a lamp of 100 W at (0, 1.2, `lamp_z`), scattered once between z = `near` and `far`.
double scattered_once(double scattering, double extinction, double g, double lamp_z, double near,
                      double far) {
  return integrate(
      [&](double z) {
        const double along = z - lamp_z;
        const double d2 = 1.44 + along * along;
        const double d = std::sqrt(d2);
        return scattering * henyey_greenstein(along / d, g) * 100.0 / (4.0 * M_PI * d2) *
               std::exp(-extinction * (near - z + d));
      },
      far, near, 1e-9, 64);
}

// Lamp and scattering are deep in a body: what the lamp does where the ray comes in counts nothing.
TEST(MediaDefects, DirectLightIsThatOfThePlaceOfScattering) {
  const YamlScene scene(defect_job(6000, 1, R"(
media: {fog: {scattering: [0.5, 0.2, 1], absorption: [0, 0.1, 0.2]}}
objects: {body: {shape: box, size: [20, 20, 6], at: [0, 0, -3], material: air, interior: fog}}
lights: {lamp: {type: point, at: [0, 1.2, -2.5], power: 100}}
)"));
  const auto expected = [](double scattering, double extinction) {
    return scattered_once(scattering, extinction, 0.0, -2.5, 0.0, -6.0);
  };
  expect_picture_mean(scene, {expected(0.5, 0.5), expected(0.2, 0.3), expected(1.0, 1.2)},
                      kDefectsPromise);
}

// What is behind a refracting surface is not lit by a straight line to the lamp, with whatever
// factor: light of a point, which nothing can meet by chance, does not come in at all.
TEST(MediaDefects, ShadowRaysDoNotCrossRefractingSurfaces) {
  const auto lit = [](const std::string& surface) {
    const YamlScene scene(defect_job(64, 64,
                                     R"(
media: {milk: {scattering: 3, absorption: 0.1}}
objects: {ball: {shape: sphere, material: )" +
                                         surface + R"(, interior: milk}}
lights: {lamp: {type: point, at: [0, 3, 3], power: 100}}
)"));
    return picture_mean(scene.render().film).mean;
  };
  EXPECT_EQ(lit("glass"), Vec3d(0.0));
  EXPECT_GT(lit("air").x, 0.02);
}

// No mean over the channels, and nothing undefined where g is 0.
TEST(MediaDefects, EveryChannelHasItsOwnMeanCosine) {
  const YamlScene scene(defect_job(20000, 1, R"(
media: {fog: {scattering: 0.4, absorption: 0.1, g: [0.6, 0, -0.4]}}
atmosphere: fog
objects: {wall: {shape: rectangle, size: [9, 9], material: black, at: [0, 0, -4], transform: [{rotate_x: 90}]}}
lights: {lamp: {type: point, at: [0, 1.2, 0.5], power: 100}}
)"));
  const auto expected = [](double g) { return scattered_once(0.4, 0.5, g, 0.5, 4.0, -4.0); };
  expect_picture_mean(scene, {expected(0.6), expected(0.0), expected(-0.4)}, kDefectsPromise);
}

// Bodies within bodies, each of its own medium, one of them empty.
TEST(MediaDefects, MediaStandWithinMedia) {
  const YamlScene scene(defect_job(16, 16, R"(
media: {fog: {absorption: 0.05}, tea: {absorption: [0.1, 0.3, 0.2]}, ink: {absorption: [0.7, 0.2, 0.4]}}
atmosphere: fog
objects:
  tea: {shape: box, size: [5, 5, 4], material: air, interior: tea}
  ink: {shape: box, size: [3, 3, 2], material: clear, interior: ink}
  bubble: {shape: box, size: [1, 1, 0.5], material: clear}
  wall: {shape: rectangle, size: [9, 9], material: black, at: [0, 0, -4], transform: [{rotate_x: 90}], emit: {radiance: 1}}
)"));
  // 2 m of fog on either side, 1 m of tea, 0.75 m of ink, and the bubble of nothing.
  const auto expected = [](double tea, double ink) {
    return std::exp(-4.0 * 0.05 - 2.0 * tea - 1.5 * ink);
  };
  expect_picture_mean(scene, {expected(0.1, 0.7), expected(0.3, 0.2), expected(0.2, 0.4)},
                      kDefectsPromise);
}

}  // namespace
}  // namespace hyades::test
