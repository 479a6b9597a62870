// Media that vary in space, from a job's text to a film.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

/// An error of 1 % is found with probability 99 %, and at most one of a hundred runs of all the
/// tests of this file fails by chance.
constexpr Promise kPromise{
    .significance = 0.01, .tests = 30, .relative_error = 0.01, .power = 0.99};

std::string job(int samples, int max_depth, const std::string& camera, const std::string& rest) {
  return R"(
hyades: 1
name: varying
film: {size: [12, 12], filter: box}
sampling: {samples: )" +
         std::to_string(samples) + R"(, seed: 3, sampler: independent}
integrator: {type: path, max_depth: )" +
         std::to_string(max_depth) + "}\ncamera: {" + camera + R"(}
materials:
  air: {type: "null"}
)" + rest;
}

/// Noise that is cut to 1 everywhere.
constexpr const char* kEven = "density: {noise: {low: 0, high: 0}}";

// T7: what a slab absorbs, and what it gives off.
TEST(VaryingMedia, EvenSlabsAbsorbAndGlow) {
  const YamlScene scene(job(600, 8,
                            "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 0.01", std::string(R"(
units: cm
media:
  neon: {absorption: [0.05, 0.35, 1], scale: 2, emission: [2, 1, 3], )") + kEven + R"(}
objects: {slab: {shape: box, size: [3, 3, 1.5], material: air, interior: neon}}
environment: {color: [1, 2, 3]}
)"));
  const auto expected = [](double sigma, double sky, double glow) {
    return sky * std::exp(-1.5 * sigma) - glow * std::expm1(-1.5 * sigma) / sigma;
  };
  expect_picture_mean(scene, {expected(0.1, 1, 2), expected(0.7, 2, 1), expected(2.0, 3, 3)},
                      kPromise);
}

// T9: the same picture of a lamp in a homogeneous body and in one of even density, with channels
// that do not scatter and do not absorb.
TEST(VaryingMedia, AnEvenDensityIsAHomogeneousBody) {
  const auto lit = [](const char* density) {
    return picture_mean(
        YamlScene(job(6000, 12, "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 20", std::string(R"(
media: {fog: {absorption: [0.5, 0, 0.2], scattering: [0, 1, 0.4], g: 0.3, )") + density + R"(}}
objects: {body: {shape: box, size: [2, 2, 2], material: air, interior: fog}}
lights: {lamp: {type: point, at: [0.2, 1.5, 0.5], power: 100}}
environment: {color: [1, 0, 0]}
)"))
            .render()
            .film);
  };
  const PictureMean even = lit(kEven);
  const PictureMean homogeneous = lit("emission: 0");
  const double alpha = sidak(kPromise.significance, kPromise.tests);
  for (int c = 0; c < 3; ++c) {
    const double variance =
        even.sigma[c] * even.sigma[c] + homogeneous.sigma[c] * homogeneous.sigma[c];
    EXPECT_LE(detectable_effect(variance, alpha, 0.99), 0.03 * homogeneous.mean[c]);
    EXPECT_GE(z_test(even.mean[c] - homogeneous.mean[c], variance), alpha)
        << even.mean[c] << " and " << homogeneous.mean[c];
  }
}

// T5: what absorbs nothing cannot be seen under a uniform sky, in any channel, moving or not.
TEST(VaryingMedia, WhiteCloudsVanishUnderAUniformSky) {
  const YamlScene scene(job(1700, 20000, "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 30", R"(
frames: {shutter: 0.5}
media:
  cloud: {scattering: [6, 20, 10], g: 0.5, density: {noise: {scale: 2, low: 0.4, high: 0.6, fade: 0.3}}}
objects:
  ball: {shape: sphere, radius: 0.8, at: ["= -0.3 + 4 * t", 0, 0], material: air, interior: cloud}
  can: {shape: cylinder, radius: 0.3, height: 0.8, at: [0.8, -0.4, 0.5], material: air, interior: cloud}
environment: {color: [1, 2, 0.5]}
)"));
  expect_picture_mean(scene, {1.0, 2.0, 0.5}, kPromise);
}

}  // namespace
}  // namespace hyades::test
