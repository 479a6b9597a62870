// Surfaces whose backs the camera does not see, against closed forms and by every integrator: it
// looks through them, and light does not come through.

#include <gtest/gtest.h>

#include <string>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

constexpr const char* kSidesIntegrators[] = {"path", "bdpt", "mlt", "{type: mlt, over: path}"};

constexpr Promise kSidesPromise{
    .significance = 0.01, .tests = 3 * 4 * 6, .relative_error = 0.02, .power = 0.99};

/// Chains have most of their error in common to all of a picture: a larger one is noticed, by as
/// many samples in several pictures.
constexpr int kSidesChains = 16;
constexpr Promise kSidesPromiseOfChains{
    .significance = 0.01, .tests = 3 * 4 * 6, .relative_error = 0.04, .power = 0.99};

void expect_sides_mean(const std::string& text, const Vec3d& expected, int samples = 700) {
  for (const char* integrator : kSidesIntegrators) {
    SCOPED_TRACE(integrator);
    const bool chains = std::string(integrator).find("mlt") != std::string::npos;
    const YamlScene scene("hyades: 1\nname: sides\nfilm: {size: [16, 16]}\nsampling: {samples: " +
                          std::to_string(chains ? samples / kSidesChains : samples) +
                          ", seed: 3, sampler: independent}\nintegrator: " + integrator + "\n" +
                          text);
    if (chains) {
      expect_mean_of_runs(scene, kSidesChains, expected, kSidesPromiseOfChains);
    } else {
      expect_picture_mean(scene, expected, kSidesPromise);
    }
  }
}

/// A matt sheet before an even sky, its front towards the camera or away from it.
std::string sheet(const std::string& keys, bool front) {
  return "camera: {look_from: [0, 0, 1], look_at: [0, 0, 0], fov: 20}\n"
         "materials: {veil: {type: lambert, color: [0.8, 0.5, 0.2], " +
         keys +
         "}}\nobjects: {plane: {shape: rectangle, size: [1, 1], material: veil, transform: "
         "[{rotate_x: " +
         (front ? "90" : "-90") + "}]}}\nenvironment: {color: 2}\n";
}

TEST(Sides, OfASheetBeforeAnEvenSkyTheCameraSeesTheFrontOnly) {
  const Vec3d matt = 2.0 * Vec3d(0.8, 0.5, 0.2);
  expect_sides_mean(sheet("sides: front", true), matt);
  expect_sides_mean(sheet("sides: front", false), Vec3d(2.0));
  expect_sides_mean(sheet("sides: both", false), matt);
  expect_sides_mean(sheet("sides: front, opacity: 0.3", true), 0.3 * matt + 0.7 * Vec3d(2.0), 1600);
}

/// A closed room of walls that shine and face inwards, below a bright sky that does not get in: of
/// radiance 1 / (1 - 0.5) everywhere, and so it is seen from outside.
TEST(Sides, ARoomIsSeenThroughItsWallsAndKeepsTheSkyOut) {
  std::string walls;
  const char* turns[] = {"at: [0, -1, 0]",
                         "transform: [{rotate_x: 180}], at: [0, 1, 0]",
                         "transform: [{rotate_x: 90}], at: [0, 0, -1]",
                         "transform: [{rotate_x: -90}], at: [0, 0, 1]",
                         "transform: [{rotate_z: -90}], at: [-1, 0, 0]",
                         "transform: [{rotate_z: 90}], at: [1, 0, 0]"};
  for (const char* turn : turns) {
    walls += "  w" + std::to_string(walls.size()) + ": {shape: rectangle, size: [2, 2], " + turn +
             ", material: wall, emit: {radiance: 1}}\n";
  }
  expect_sides_mean(
      "camera: {look_from: [0, 0, 5], look_at: [0, 0, 0], fov: 20}\n"
      "materials: {wall: {type: lambert, color: 0.5, sides: front}}\nobjects:\n" +
          walls + "environment: {color: 50}\n",
      Vec3d(2.0));
}

/// What cannot be seen does not shine for the camera either, and shines for all else: a small lamp
/// of 10 W/(m^2 sr), which is not seen from above, lights the floor that the camera sees through
/// it.
TEST(Sides, ALampIsNotSeenFromBehindButLights) {
  expect_sides_mean(R"(
camera: {look_from: [0, 8, 0], look_at: [0, 0, 0], up: [0, 0, -1], fov: 0.1}
materials: {floor: {type: lambert, color: 0.5}, lamp: {type: black, sides: front}}
objects:
  floor: {shape: rectangle, size: [0.1, 0.1], material: floor}
  lamp: {shape: rectangle, size: [0.1, 0.1], transform: [{rotate_x: 180}], at: [0, 4, 0], material: lamp, emit: {radiance: 10, two_sided: true}}
)",
                    // h^2 / (h^2 + r^2)^2 over the lamp, to the first order of its r^2: 0.01 / 6.
                    Vec3d(0.5 / M_PI * 10.0 * 0.01 / 16.0 * (1.0 - 2.0 * (0.01 / 6.0) / 16.0)),
                    1024);
}

}  // namespace
}  // namespace hyades::test
