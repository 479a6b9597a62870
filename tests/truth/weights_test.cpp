// T13: the weights of all strategies that can find a path add up to 1. For paths that bidirectional
// path tracing finds, the densities of all strategies are computed here by brute force, out of the
// path's places and the densities of lights, materials, phase functions and the camera, and
// normalised; each weight must be that share. So it is the same function of the path whichever
// strategy found it, and adds up to 1.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "core/integrators/found_path.h"
#include "core/integrators/integrator.h"
#include "core/samplers/sampler.h"
#include "tests/truth/path_densities.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::FoundPath;

class Weigher final : public core::PathWatcher {
 public:
  explicit Weigher(const core::Scene& scene) : scene_(scene) {}

  void found(const FoundPath& path) override {
    const PathDensities all(scene_, path);
    if (!all.clear()) {
      ++unclear;
      return;
    }
    ++compared;
    ++seen[{path.s, path.t}];
    const double expected = all.weight(path.s);
    const double error = std::abs(path.weight - expected);
    off += !(error <= 1e-5);
    // Rounding of places to float.
    EXPECT_LE(error, 1e-4) << path.weight << ", not " << expected << " (s = " << path.s
                           << ", t = " << path.t << ")";
  }

  int compared = 0;
  int unclear = 0;
  int off = 0;
  std::map<std::pair<int, int>, int> seen;  ///< strategies

 private:
  const core::Scene& scene_;
};

/// A weight that is wrong by 1e-4 for one path in ten thousand is noticed.
void expect_weights(const std::string& scene_text) {
  const YamlScene yaml(
      "hyades: 1\nname: weights\nfilm: {size: [16, 12], filter: {type: box, radius: 0.5}}\n"
      "sampling: {samples: 1}\nintegrator: {type: bdpt, max_depth: 6, roulette_depth: 100}\n" +
      scene_text);
  const core::Scene& scene = yaml.renderer().scene();
  const auto integrator = core::make_integrator(yaml.job().integrator);
  const auto sampler = core::make_sampler(core::SamplerKind::independent);
  Weigher weigher(scene);
  core::Workspace work;
  work.watcher = &weigher;
  for (uint32_t i = 0; i < 40000 && !testing::Test::HasFailure(); ++i) {
    const core::Vec2i pixel(i % 16, i / 16 % 12);
    sampler->start({5, 1, pixel, i});
    const core::Vec2 film = core::Vec2(pixel) + sampler->next_2d();
    const core::Vec2 lens = sampler->next_2d();
    integrator->sample(scene, scene.camera->generate(film, lens, 0.0F), *sampler, work);
    work.splats.clear();
  }
  EXPECT_GT(weigher.compared, 30000);
  EXPECT_LT(weigher.unclear, weigher.compared / 10);
  EXPECT_LE(weigher.off, weigher.compared / 10000);
  for (int vertices = 3; vertices <= 6; ++vertices) {
    for (int s = 0; s < vertices; ++s) {
      EXPECT_GE((weigher.seen[{s, vertices - s}]), 5) << "s = " << s << ", t = " << vertices - s;
    }
  }
}

TEST(Weights, OfSurfacesAndDeltaLobes) {
  expect_weights(R"(
camera: {look_from: [0, 1, 3.4], look_at: [0, 0.8, 0], fov: 45}
materials:
  white: {type: lambert, color: 0.7}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.5}
  mirror: {type: mirror, color: 0.9}
  half: {type: mix, first: white, second: mirror, amount: 0.5}
  glass: {type: dielectric, ior: 1.5}
  frosted: {type: dielectric, ior: 1.5, roughness: 0.5}
  pane: {type: thin-dielectric, ior: 1.5}
objects:
  floor: {shape: rectangle, size: [4, 4], material: half}
  back: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 90}], at: [0, 1, -1], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0.5, 0.5, 0], material: glass}
  drop: {shape: sphere, radius: 0.3, at: [-0.4, 0.4, 0.4], material: frosted}
  box: {shape: box, size: [0.4, 0.4, 0.4], at: [-0.8, 0.7, -0.2], material: shiny}
  plate: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 80}], at: [0.6, 0.6, 0.8], material: pane}
  lamp: {shape: rectangle, size: [0.8, 0.8], transform: [{rotate_x: 180}], at: [0, 1.95, 0], emit: {radiance: 12}}
  globe: {shape: sphere, radius: 0.2, at: [-0.9, 1.4, 0], emit: {radiance: 12}}
  cube: {shape: box, size: [0.2, 0.2, 0.2], at: [0.9, 1.4, 0], emit: {radiance: 5}}
lights:
  a: {type: point, at: [-0.8, 1.5, 0.4], power: 40}
  b: {type: spot, at: [0.9, 1.6, 0.5], look_at: [0.2, 0, 0], angle: 35, blend: 0.4, power: 60}
)");
}

TEST(Weights, OfMedia) {
  expect_weights(R"(
camera: {look_from: [0, 1, 3], look_at: [0, 0.7, 0], fov: 45}
media:
  fog: {scattering: [0.3, 0.2, 0.1], absorption: [0.02, 0.05, 0.1], g: 0.5}
  cloud: {scattering: [4, 3, 2], g: -0.3}
  milk: {scattering: [4, 5, 6], absorption: [0.3, 0.1, 0.05], g: 0.5}
atmosphere: fog
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  air: {type: "null"}
  glass: {type: dielectric, ior: 1.3}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  smoke: {shape: box, size: [0.6, 0.6, 0.6], at: [0.6, 0.5, 0], material: air, interior: cloud}
  ball: {shape: sphere, radius: 0.4, at: [-0.5, 0.5, 0], material: glass, interior: milk}
  lamp: {shape: sphere, radius: 0.25, at: [0.7, 1.7, 0.2], emit: {radiance: 15}}
lights:
  a: {type: point, at: [-0.8, 1.5, 0.4], power: 40}
)");
}

/// Metal, glass and a cloud on a disk, which lenses look at; objects may follow.
const std::string kStillLife = R"yaml(media: {mist: {scattering: 1, g: 0.2}}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, ior: 1.5}
  air: {type: "null"}
  chrome: {type: conductor, metal: copper, roughness: 0.4}
objects:
  floor: {shape: disk, radius: 3, material: white}
  ball: {shape: sphere, radius: 0.5, at: [0.5, 0.6, 0], material: chrome}
  drop: {shape: sphere, radius: 0.4, at: [-0.6, 0.6, 0.3], material: glass}
  smoke: {shape: box, size: [1, 0.6, 0.6], at: [0, 1.4, 0], material: air, interior: mist}
)yaml";

TEST(Weights, UnderASkyThroughALens) {
  expect_weights(R"yaml(
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 35, aperture: {radius: 0.2}, focus: 3}
)yaml" + kStillLife +
                 R"yaml(lights:
  sun: {type: sun, direction: [1, -2, -1], irradiance: 2, angle: 8}
  moon: {type: sun, direction: [-1, -1, 0], irradiance: 0.7, angle: 0}
environment: {image: jobs/quickstart/dusk.exr, strength: 0.8}
)yaml");
}

/// Their light paths find the film along one direction, and not by solid angle.
TEST(Weights, OfParallelRaysThroughALens) {
  expect_weights(
      R"yaml(
camera: {type: orthographic, look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], height: 2.6, aperture: {radius: 0.2}, focus: 4}
)yaml" +
      kStillLife +
      R"yaml(  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.9, 0.8], emit: {radiance: 15}}
lights:
  sun: {type: sun, direction: [1, -2, -1], irradiance: 2, angle: 8}
)yaml");
}

TEST(Weights, OfPanoramas) {
  expect_weights(R"(
camera: {type: equirectangular, look_from: [0, 0.9, 0], look_at: [1, 0.9, 0.4]}
media: {mist: {scattering: 0.3, g: 0.2}}
atmosphere: mist
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, ior: 1.5}
objects:
  floor: {shape: disk, radius: 3, material: white}
  ball: {shape: sphere, radius: 0.5, at: [1.5, 0.6, 0], material: glass}
  wall: {shape: box, size: [0.3, 2, 2], at: [-1.4, 1, 0], material: white}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.9, 0.8], emit: {radiance: 15}}
)");
}

}  // namespace
}  // namespace hyades::test
