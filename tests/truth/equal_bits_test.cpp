// Invariants 1 and 2: however the work is cut, the film's digest is the same.

#include <gtest/gtest.h>

#include <iterator>
#include <string>
#include <vector>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

struct NamedScene {
  const char* name;
  const char* yaml;
  bool has_light_paths = false;
};

void PrintTo(const NamedScene& scene, std::ostream* out) { *out << scene.name; }

constexpr NamedScene kScenes[] = {
    {"mesh_and_lamp", R"(
hyades: 1
name: mesh
film: {size: [70, 45]}
sampling: {samples: 40, seed: 9}
camera: {look_from: [4.2, 4.6, 7.2], look_at: [0, 0, 0], fov: 40}
objects:
  knot: {mesh: jobs/mesh-100k/knot.ply}
  ground: {shape: rectangle, size: [60, 60], at: [0, -1.7, 0]}
  lamp: {shape: rectangle, size: [4, 4], transform: [{rotate_z: 145}], at: [-5, 7, 2], emit: {radiance: 20}}
)"},
    {"glossy_under_a_sky", R"(
hyades: 1
name: glossy
film: {size: [64, 48], filter: {type: mitchell, radius: 2}}
sampling: {samples: 33, seed: 2}
camera: {look_from: [0, 1.5, 5], look_at: [0, 1, 0], fov: 40, aperture: {radius: 0.05}}
textures:
  waves: {type: fbm4d, scale: 3, octaves: 3, time: 0.7}
materials:
  floor: {type: glossy, color: waves, reflectiveness: 0.4, glossiness: 0.7}
  gold: {type: conductor, metal: gold, roughness: 0.3, bump: {texture: waves, height: 0.1}}
  glass: {type: dielectric, ior: 1.5}
objects:
  ground: {shape: rectangle, size: [20, 20], material: floor}
  ball: {shape: sphere, radius: 0.8, at: [-0.9, 0.8, 0], material: gold}
  drop: {shape: sphere, radius: 0.8, at: [0.9, 0.8, 0.4], material: glass}
environment: {image: jobs/quickstart/dusk.exr}
)"},
    {"motion_blur", R"(
hyades: 1
name: motion
frames: {range: 1-4, fps: 24, shutter: 0.8}
film: {size: [60, 40]}
sampling: {samples: 32, seed: 4}
camera: {look_from: {keys: {1: [0, 1.5, 6], 4: [1, 1.5, 6]}}, look_at: [0, 0.8, 0], fov: 40}
objects:
  ground: {shape: rectangle, size: [20, 20]}
  box: {shape: box, size: [1, 1, 1], transform: [{rotate_y: "= 400 * t"}], at: ["= 6 * t", 0.5, 0]}
  ball: {shape: sphere, radius: 0.4, at: [-1.2, "= 0.4 + 5 * t", 0.5]}
environment: {color: [0.6, 0.7, 0.9]}
)"},
    {"light_paths", R"(
hyades: 1
name: light
film: {size: [70, 50], crop: [3, 5, 69, 47], filter: {type: gaussian, radius: 1.5}}
sampling: {samples: 24, seed: 4}
integrator: {type: bdpt, max_depth: 5}
camera: {look_from: [0, 1.5, 6], look_at: [0, 0.8, 0], fov: 40}
media: {fog: {scattering: [0.04, 0.05, 0.06], g: 0.5}}
atmosphere: fog
objects:
  ground: {shape: rectangle, size: [20, 20]}
  ball: {shape: sphere, radius: 0.8, at: [0, 0.8, 0]}
  lamp: {shape: sphere, radius: 0.4, at: [2, 2, 0.5], emit: {radiance: 20}}
)",
     true},
    {"chains", R"(
hyades: 1
name: chains
film: {size: [150, 80], crop: [3, 5, 149, 77], filter: {type: gaussian, radius: 1.5}}
sampling: {samples: 20, seed: 4}
integrator: {type: mlt, max_depth: 4}
camera: {look_from: [0, 1.5, 6], look_at: [0, 0.8, 0], fov: 40}
objects:
  ground: {shape: rectangle, size: [20, 20]}
  ball: {shape: sphere, radius: 0.8, at: [0, 0.8, 0]}
lights:
  lamp: {type: point, at: [2, 2, 0.5], power: 100}
)",
     true},
    {"coplanar_duplicates", R"(
hyades: 1
name: coplanar
film: {size: [50, 50]}
sampling: {samples: 32, seed: 5}
camera: {look_from: [0, 3, 4], look_at: [0, 0, 0], fov: 40}
materials:
  red: {type: lambert, color: [0.8, 0.1, 0.1]}
  blue: {type: lambert, color: [0.1, 0.1, 0.8]}
objects:
  one: {shape: rectangle, size: [2, 2], material: red}
  two: {shape: rectangle, size: [2, 2], material: blue}
  three: {shape: rectangle, size: [4, 4], material: red, transform: [{rotate_y: 30}]}
  cube: {shape: box, size: [1, 1, 1], material: blue, at: [0, 0.5, 0]}
  same_cube: {shape: box, size: [1, 1, 1], material: red, at: [0, 0.5, 0]}
environment: {color: 1}
)"},
};

class EqualBits : public testing::TestWithParam<NamedScene> {};

TEST_P(EqualBits, WhateverThreadsTilesOrder) {
  const YamlScene scene(GetParam().yaml, 1, {.depth = true, .albedo = true, .normal = true});
  const core::RenderedFrame first =
      scene.render({.threads = 1, .tile_size = 32, .batches_per_unit = 4});
  EXPECT_EQ(first.counters.bad_samples, 0U);
  const std::string digest = first.film.digest();
  for (const int threads : {2, 7}) {
    for (const int tile : {8, 32, 57}) {
      const auto again = scene.render({.threads = threads,
                                       .tile_size = tile,
                                       .batches_per_unit = tile == 8 ? 1U : 2U,
                                       .shuffle = true});
      EXPECT_EQ(again.film.digest(), digest) << threads << " threads, tiles of " << tile;
    }
  }
}

/// Scenes without light paths, which concern all pixels that are rendered: with them the film of a
/// crop is of another picture.
class EqualBitsOfCrops : public testing::TestWithParam<NamedScene> {};

TEST_P(EqualBitsOfCrops, AreThoseOfTheWholePicture) {
  const YamlScene scene(GetParam().yaml);
  ASSERT_FALSE(scene.renderer().layout().layers.splats);
  const core::PixelRect crop{13, 7, 41, 30};
  const auto whole = scene.render({.threads = 2});
  const auto part = core::render_frame(scene.renderer(), crop, scene.job().sampling.samples, 1,
                                       {.threads = 2, .tile_size = 11});
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) {
      for (int c = 0; c < 4; ++c)
        ASSERT_EQ(part.film.sum(x, y, c), whole.film.sum(x, y, c)) << x << "," << y;
    }
  }
}

TEST_P(EqualBits, OtherSeedOtherBits) {
  // Shows that the digest sees the pixels at all.
  std::string other = GetParam().yaml;
  other.replace(other.find("seed: "), 7, "seed: 8");
  EXPECT_NE(YamlScene(other).render().film.digest(),
            YamlScene(GetParam().yaml).render().film.digest());
}

std::vector<NamedScene> without_light_paths() {
  std::vector<NamedScene> scenes(std::begin(kScenes), std::end(kScenes));
  std::erase_if(scenes, [](const NamedScene& scene) { return scene.has_light_paths; });
  return scenes;
}

std::string name_of(const testing::TestParamInfo<NamedScene>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, EqualBits, testing::ValuesIn(kScenes), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, EqualBitsOfCrops, testing::ValuesIn(without_light_paths()),
                         name_of);

}  // namespace
}  // namespace hyades::test
