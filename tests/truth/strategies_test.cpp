// T13: each strategy of bidirectional path tracing alone, unweighted, finds all light that is
// scattered so many times, where it can; together, weighted, they find it once. With T12 that is
// what weights that add up to 1 for every path come to.

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

constexpr int kStrategyRuns = 16;

/// A large lamp, which camera paths meet by chance, and things that do not touch: where they do,
/// the light between places that are next to each other has no variance that a test could go by.
std::string scene_with(const std::string& things) {
  return R"(
hyades: 1
name: strategies
film: {size: [20, 16], filter: {type: gaussian, radius: 1}}
sampling: {samples: 160, seed: 3}
integrator: bdpt
camera: {look_from: [0, 1, 2.6], look_at: [0, 0.7, 0], fov: 50, aperture: {radius: 0.03}, focus: 2.6}
materials:
  white: {type: lambert, color: [0.9, 0.7, 0.5]}
  satin: {type: glossy, color: [0.5, 0.7, 0.9], reflectiveness: 0.5, glossiness: 0.4}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [2, 2], material: white}
  lamp: {shape: rectangle, size: [1.6, 1.6], transform: [{rotate_x: 180}], at: [0, 1.9, 0], emit: {radiance: 4}}
)" + things;
}

/// Everything that is scattered just `events` times.
core::IntegratorDesc only(const core::IntegratorDesc& base, int events) {
  core::IntegratorDesc desc = base;
  desc.min_events = desc.max_depth = events;
  return desc;
}

/// The strategies for `events` events from `first` to `last` light vertices.
void expect_strategies_agree(const YamlScene& scene, int events, int first, int last,
                             const Promise& promise) {
  core::IntegratorDesc desc = only(scene.job().integrator, events);
  desc.type = "path";
  const Replicates path = render_replicates(scene, desc, kStrategyRuns, 4);
  desc.type = "bdpt";
  expect_same_picture(path, render_replicates(scene, desc, kStrategyRuns, 4), promise);
  desc.mis = false;
  for (int s = first; s <= last; ++s) {
    desc.light_vertices = s;
    desc.camera_vertices = events + 2 - s;
    SCOPED_TRACE("s = " + std::to_string(s) + ", t = " + std::to_string(events + 2 - s));
    expect_same_picture(path, render_replicates(scene, desc, kStrategyRuns, 4), promise);
  }
}

/// Red, green and blue of each pixel.
std::vector<double> picture_of(const YamlScene& scene, const core::IntegratorDesc& integrator) {
  const core::Image picture = scene.render_by(integrator).film.normalised();
  std::vector<double> values;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int c = 0; c < 3; ++c) values.push_back(double{picture.at(x, y, c)});
    }
  }
  return values;
}

TEST(Strategies, EachFindsAllLightBetweenSurfaces) {
  const YamlScene scene(scene_with(
      "  wall: {shape: rectangle, size: [1.4, 1], transform: [{rotate_z: -90}], at: [-1.2, "
      "0.9, 0], material: white}\n"
      "  ball: {shape: sphere, radius: 0.3, at: [0.3, 0.8, 0], material: satin}\n"));
  Promise promise{
      .significance = 0.005, .tests = 3 * (4 + 5 + 5), .relative_error = 0.02, .power = 0.99};
  expect_strategies_agree(scene, 1, 0, 2, promise);
  promise.relative_error = 0.075;
  expect_strategies_agree(scene, 2, 0, 3, promise);
  promise.relative_error = 0.1;
  expect_strategies_agree(scene, 3, 1, 4, promise);
}

// What light paths scatter is not what camera paths scatter where shading normals are not those of
// the surface (Veach 1997, section 5.3).
TEST(Strategies, EachFindsAllLightOnSmoothedMeshes) {
  const YamlScene scene(scene_with(
      "  ball: {mesh: tests/truth/coarse_ball.obj, normals: smooth, transform: [{scale: 0.5}], at: "
      "[0, 0.75, 0], material: satin}\n"));
  const Promise promise{
      .significance = 0.005, .tests = 3 * (4 + 4), .relative_error = 0.15, .power = 0.99};
  expect_strategies_agree(scene, 1, 0, 2, promise);
  expect_strategies_agree(scene, 2, 1, 3, promise);
}

// The very samples of the picture, cut by strategy: what is left is rounding. Were the weights of a
// path's strategies not to add up to 1 by a thousandth, this would notice.
TEST(Strategies, WeightedPartsAddUpToThePicture) {
  const YamlScene scene(
      scene_with("  ball: {shape: sphere, radius: 0.3, at: [0.3, 0.8, 0], material: satin}\n"));
  core::IntegratorDesc desc = only(scene.job().integrator, 2);
  const std::vector<double> whole = picture_of(scene, desc);
  std::vector<double> sum(whole.size());
  for (int s = 0; s <= 3; ++s) {
    desc.light_vertices = s;
    desc.camera_vertices = 4 - s;
    const std::vector<double> part = picture_of(scene, desc);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
  }
  const double mean = std::accumulate(whole.begin(), whole.end(), 0.0) / double(whole.size());
  EXPECT_GT(mean, 0.001);
  for (size_t i = 0; i < sum.size(); ++i)
    ASSERT_NEAR(sum[i], whole[i], 1e-4 * (whole[i] + mean)) << "value " << i;
}

// Places in a medium may come as near to each other as they like: of what joins them alone only
// the weighted sum can be tested, which is so with all integrators.
TEST(Strategies, EachFindsAllLightInAMedium) {
  const YamlScene scene(scene_with(
      "  cloud: {shape: box, size: [1, 0.8, 0.8], at: [0, 0.8, 0], material: air, interior: "
      "fog}\n"
      "media: {fog: {scattering: [1, 1.2, 1.4], absorption: [0.1, 0.05, 0.02], g: 0.4}}\n"));
  const Promise promise{
      .significance = 0.005, .tests = 3 * (4 + 2 + 2), .relative_error = 0.075, .power = 0.99};
  expect_strategies_agree(scene, 1, 0, 2, promise);
  expect_strategies_agree(scene, 2, 1, 1, promise);
  expect_strategies_agree(scene, 2, 3, 3, promise);
}

}  // namespace
}  // namespace hyades::test
