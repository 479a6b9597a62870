// T6: in closed diffuse spheres the radiance is known exactly, and the same on every wall: for
// every integrator, sampler and camera.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <tuple>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

const Vec3d kAlbedo(0.6, 0.4, 0.2);

struct Room {
  const char* name;
  const char* text;
  double (*radiance)(double albedo);  ///< of every wall
};

const Room kRooms[] = {
    // Everything emits E and reflects albedo rho, so that everywhere L = E + rho L.
    {"that_glows", R"(
objects:
  room: {shape: sphere, radius: 2, material: wall, emit: {radiance: 3, two_sided: true}}
)",
     [](double albedo) { return 3.0 / (1.0 - albedo); }},
    // E_0 = Phi / (4 pi R^2) on every wall, L = rho E_0 / (pi (1 - rho)).
    {"with_a_point", R"(
objects:
  room: {shape: sphere, radius: 2, material: wall}
lights:
  lamp: {type: point, at: [0, 0, 0], power: 100}
)",
     [](double albedo) { return albedo * 100.0 / (16.0 * M_PI) / (M_PI * (1.0 - albedo)); }},
    // The lamp covers the share q = (r / R)^2 of what a wall sees: E = pi L_e q + rho (1 - q) E.
    {"with_a_black_lamp", R"(
objects:
  room: {shape: sphere, radius: 2, material: wall}
  lamp: {shape: sphere, radius: 0.5, material: lamp, emit: {radiance: 4}, visible_to_camera: false}
)",
     [](double albedo) { return albedo * 4.0 / 16.0 / (1.0 - albedo * (1.0 - 1.0 / 16.0)); }},
};

struct Integrator {
  const char* name;
  const char* text;
  int samples;
  double relative_error;  ///< of the mean of a picture that is noticed with 99 % probability
};

const Integrator kIntegrators[] = {
    {"path", "path", 24, 0.015},
    {"bdpt", "bdpt", 10, 0.015},
    {"mlt_over_bdpt", "mlt, over: bdpt", 12, 0.04},
    {"mlt_over_path", "mlt, over: path", 24, 0.04},
};

const char* const kCameras[] = {
    "look_from: [0.2, 0.3, 1.4], look_at: [0.7, -0.2, 3], fov: 60",
    "look_from: [0.2, 0.3, 1.4], look_at: [0.7, -0.2, 3], fov: 40, aperture: {radius: 0.1, blades: "
    "5}, focus: 0.5",
    "type: orthographic, look_from: [0.2, 0.3, 1.4], look_at: [0.7, -0.2, 3], height: 0.6",
    "type: equirectangular, look_from: [0.2, 0.3, 1.4], look_at: [0.7, -0.2, 3]",
};
/// Those with both samplers; the others have one of them, for time's sake.
constexpr size_t kCamerasWithBoth = 2;

void PrintTo(const Room& room, std::ostream* out) { *out << room.name; }
void PrintTo(const Integrator& integrator, std::ostream* out) { *out << integrator.name; }

class ClosedRooms : public testing::TestWithParam<std::tuple<Room, Integrator>> {};

TEST_P(ClosedRooms, AreEvenlyBrightForEverySamplerAndCamera) {
  const auto& [room, integrator] = GetParam();
  constexpr int kRuns = 20;
  constexpr int kTests = 6 * 2 * 3 * static_cast<int>(std::size(kRooms) * std::size(kIntegrators));
  for (const char* sampler : {"independent", "sobol"}) {
    // Chains have their own numbers.
    const bool chains = integrator.text[0] == 'm';
    if (chains && sampler[0] == 's') continue;
    for (size_t i = 0; i < std::size(kCameras); ++i) {
      if (i >= kCamerasWithBoth && !chains && sampler[0] == 'i') continue;
      const char* camera = kCameras[i];
      // Of all around, chains need more to tell as much.
      const int samples = integrator.samples * (chains && i >= kCamerasWithBoth ? 4 : 1);
      SCOPED_TRACE(std::string(sampler) + ", " + camera);
      const YamlScene scene(
          "hyades: 1\nname: room\nfilm: {size: [12, 12], filter: {type: box, radius: 0.5}}\n"
          "sampling: {samples: " +
          std::to_string(samples) + ", seed: 3, sampler: " + sampler +
          "}\nintegrator: {type: " + integrator.text + ", max_depth: 40}\ncamera: {" + camera +
          R"(}
materials:
  wall: {type: lambert, color: [0.6, 0.4, 0.2]}
  lamp: {type: black})" +
          room.text);
      const Replicates picture = render_replicates(scene, kRuns, 6);
      EXPECT_EQ(picture.bad_samples, 0U);
      for (size_t c = 0; c < 3; ++c) {
        const double expected = room.radiance(kAlbedo[static_cast<int>(c)]);
        EXPECT_TRUE(mean_is(picture.picture[c], expected,
                            {.significance = 0.005,
                             .tests = kTests,
                             .relative_error = integrator.relative_error,
                             .power = 0.99}))
            << "channel " << c;
        for (const auto& block : picture.blocks) {
          EXPECT_GE(t_test(block[c], expected),
                    sidak(0.005, kTests * static_cast<int>(picture.blocks.size())))
              << "channel " << c << ": " << block[c].mean() << ", not " << expected;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ClosedRooms, testing::Combine(testing::ValuesIn(kRooms), testing::ValuesIn(kIntegrators)),
    [](const auto& test) {
      return std::string(std::get<0>(test.param).name) + "_by_" + std::get<1>(test.param).name;
    });

}  // namespace
}  // namespace hyades::test
