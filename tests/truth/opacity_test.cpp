// Surfaces that are not all there, against closed forms and by every integrator: light passes them
// straight, on its way to the camera and in shadows.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

constexpr const char* kOpacityIntegrators[] = {"path", "bdpt", "mlt", "{type: mlt, over: path}"};

constexpr Promise kOpacityPromise{
    .significance = 0.01, .tests = 3 * 4 * 7, .relative_error = 0.02, .power = 0.99};

/// Chains have most of their error in common to all of a picture: a larger one is noticed, by as
/// many samples in several pictures.
constexpr int kOpacityChains = 16;
constexpr Promise kOpacityPromiseOfChains{
    .significance = 0.01, .tests = 3 * 4 * 7, .relative_error = 0.04, .power = 0.99};

YamlScene scene_of(const std::string& integrator, const std::string& text, int samples = 400) {
  return YamlScene("hyades: 1\nname: opacity\nfilm: {size: [16, 16]}\nsampling: {samples: " +
                   std::to_string(samples) +
                   ", seed: 3, sampler: independent}\nintegrator: " + integrator + "\n" + text);
}

void expect_opacity_mean(const std::string& text, const Vec3d& expected, int samples = 400) {
  for (const char* integrator : kOpacityIntegrators) {
    SCOPED_TRACE(integrator);
    if (std::string(integrator).find("mlt") == std::string::npos) {
      expect_picture_mean(scene_of(integrator, text, samples), expected, kOpacityPromise);
    } else {
      expect_mean_of_runs(scene_of(integrator, text, samples / kOpacityChains), kOpacityChains,
                          expected, kOpacityPromiseOfChains);
    }
  }
}

TEST(Opacity, APlaneBeforeAnEvenSkyShowsItsShare) {
  expect_opacity_mean(R"(
camera: {look_from: [0, 0, 1], look_at: [0, 0, 0], fov: 20}
materials: {veil: {type: lambert, color: [0.8, 0.5, 0.2], opacity: 0.3}}
objects: {plane: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], material: veil}}
environment: {color: 2}
)",
                      2.0 * (Vec3d(0.7) + 0.3 * Vec3d(0.8, 0.5, 0.2)));
}

TEST(Opacity, ATextureSaysHowMuchIsThere) {
  expect_opacity_mean(R"(
camera: {look_from: [0, 0, 1], look_at: [0, 0, 0], fov: 20}
textures: {cells: {type: checker, a: 0, b: 0.5, scale: 32}}
materials: {veil: {type: black, opacity: cells}}
objects: {plane: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], material: veil}}
environment: {color: 2}
)",
                      Vec3d(1.5));
}

TEST(Opacity, LampsShineAsFarAsTheyAreThere) {
  expect_opacity_mean(R"(
camera: {look_from: [0, 0, 1], look_at: [0, 0, 0], fov: 20}
materials: {veil: {type: black, opacity: 0.3}}
objects: {plane: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], material: veil, emit: {radiance: 5}}}
environment: {color: 1}
)",
                      Vec3d(0.3 * 5.0 + 0.7));
  // A far lamp of 20 W, seen straight on from below.
  expect_opacity_mean(R"(
camera: {look_from: [0, 0.3, 0], look_at: [0, 0, 0], up: [0, 0, -1], fov: 0.1}
textures: {cells: {type: checker, a: 0.2, b: 0.6, scale: 8}}
materials:
  paper: {type: lambert, color: [0.8, 0.5, 0.2]}
  lace: {type: black, opacity: cells}
objects:
  floor: {shape: rectangle, size: [0.01, 0.01], material: paper}
  lamp: {shape: rectangle, size: [0.1, 0.1], transform: [{rotate_x: 180}], at: [0, 4, 0], material: lace, emit: {color: cells, power: 20}}
)",
                      Vec3d(0.8, 0.5, 0.2) * (20.0 / (M_PI * M_PI * 16.0)), 1024);
}

TEST(Opacity, ShadowsAreTheProductOfWhatIsLeft) {
  const double e = 30.0 / (4.0 * M_PI * 4.0);
  expect_opacity_mean(R"(
camera: {look_from: [0, 0.3, 0], look_at: [0, 0, 0], up: [0, 0, -1], fov: 0.1}
materials:
  paper: {type: lambert, color: [0.8, 0.5, 0.2]}
  half: {type: black, opacity: 0.5}
  fifth: {type: black, opacity: 0.2}
objects:
  floor: {shape: rectangle, size: [0.01, 0.01], material: paper}
  a: {shape: rectangle, size: [9, 9], at: [0, 0.5, 0], material: half}
  b: {shape: sphere, radius: 0.3, at: [0, 1, 0], material: fifth}
lights: {lamp: {type: point, at: [0, 2, 0], power: 30}}
)",
                      Vec3d(0.8, 0.5, 0.2) * (e / M_PI * 0.5 * 0.8 * 0.8), 1024);
}

// Light that passes the surface is in the body, though nothing there refracts.
TEST(Opacity, WhatPassesIsInTheBody) {
  const Vec3d through(std::exp(-0.5), std::exp(-1.0), std::exp(-0.1));
  expect_opacity_mean(R"(
camera: {look_from: [0, 0, 5], look_at: [0, 0, 0], fov: 2}
media: {ink: {absorption: [0.5, 1, 0.1]}}
materials: {veil: {type: black, opacity: 0.25}}
objects: {box: {shape: box, size: [2, 2, 1], material: veil, interior: ink}}
environment: {color: 1}
)",
                      0.75 * 0.75 * through);
}

// A mix has the mean opacity of its parts, and each part's share of what is there.
TEST(Opacity, AMixIsThereAsItsPartsAre) {
  expect_opacity_mean(
      R"(
camera: {look_from: [0, 0, 1], look_at: [0, 0, 0], fov: 20}
materials:
  veil: {type: lambert, color: [0.8, 0.5, 0.2], opacity: 0.2}
  paper: {type: lambert, color: [0.1, 0.3, 0.9]}
  both: {type: mix, first: veil, second: paper, amount: 0.25, opacity: 0.5}
objects: {plane: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], material: both}}
environment: {color: 1}
)",
      Vec3d(0.8) + 0.5 * (0.15 * Vec3d(0.8, 0.5, 0.2) + 0.25 * Vec3d(0.1, 0.3, 0.9)));
}

}  // namespace
}  // namespace hyades::test
