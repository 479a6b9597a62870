// Media that vary in space, from a job's text to a film.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/base/color.h"
#include "tests/support/temp_folder.h"
#include "tests/support/vdb_writer.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

/// An error of 1 % is found with probability 99 %, and at most one of a hundred runs of all the
/// tests of this file fails by chance.
constexpr Promise kVaryingPromise{
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
                      kVaryingPromise);
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
  const double alpha = sidak(kVaryingPromise.significance, kVaryingPromise.tests);
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
  expect_picture_mean(scene, {1.0, 2.0, 0.5}, kVaryingPromise);
}

// A .vdb where the file says it is: along an axis the integral of interpolated values is their sum.
// One grid absorbs, one glows as a black body, by their own places in the file.
TEST(VaryingMedia, VdbGridsAbsorbAndGlowWhereTheyLie) {
  TempFolder folder;
  const auto smoke = vdb_box<openvdb::FloatGrid>(
      "density", 12, 0.25, {-1.5, -1.5, -1.0}, [](int, int, int k) { return k < 6 ? 0.5F : 1.0F; });
  const auto heat = vdb_box<openvdb::FloatGrid>("heat", 20, 0.1, {-1.5, -1.5, -1.0},
                                                [](int, int, int) { return 1.0F; });
  std::ofstream(folder.file("smoke.vdb"), std::ios::binary) << vdb_file({smoke, heat});
  const auto job_of = [&](const std::string& medium) {
    return job(14000, 4, "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 0.01", R"(
media: {smoke: {)" + medium + R"(}}
objects: {body: {shape: box, size: [4, 4, 6], material: air, interior: smoke}}
environment: {color: [1, 2, 3]}
)");
  };
  const std::string density = "density: {vdb: smoke.vdb, place: native}";
  const double passed = 0.25 * (6 * 0.5 + 6 * 1.0);
  expect_mean_by_path_and_bdpt(
      YamlScene(job_of("absorption: [0.2, 0.5, 1], " + density), 1, {}, folder.path().string()),
      {std::exp(-0.2 * passed), 2.0 * std::exp(-0.5 * passed), 3.0 * std::exp(-1.0 * passed)},
      kVaryingPromise);
  // 19 cells of 3000 K, and one at each end over which the temperature falls to 0.
  Vec3d glow = 1.9 * 16.0 * Vec3d(core::blackbody_color(3000.0F));
  for (int i = 0; i < 1000; ++i) {
    const double t = (i + 0.5) / 1000.0;
    if (t * 3000.0 < 500.0) continue;
    glow += 2.0 * 0.1 / 1000.0 * std::pow(2.0 * t, 4.0) *
            Vec3d(core::blackbody_color(static_cast<float>(3000.0 * t)));
  }
  expect_mean_by_path_and_bdpt(
      YamlScene(job_of("emission: {temperature: heat, kelvin: 3000, strength: 0.05}, " + density),
                1, {}, folder.path().string()),
      Vec3d(1.0, 2.0, 3.0) + 0.05 * glow, kVaryingPromise);
}

// A sky wrapped around nothing: glowing and scattering white, it does not darken a uniform sky.
TEST(VaryingMedia, WhiteShellsVanishUnderAUniformSky) {
  const YamlScene scene(job(1000, 20000, "look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 30", R"(
media:
  sky: {scattering: 20, density: {shell: {image: jobs/quickstart/dusk.exr, inner: 0.6, swirl: 0.1, tint: false}}}
objects:
  ball: {shape: sphere, radius: 1, material: air, interior: sky}
environment: {color: [1, 2, 0.5]}
)"));
  expect_picture_mean(scene, {1.0, 2.0, 0.5}, kVaryingPromise);
}

}  // namespace
}  // namespace hyades::test
