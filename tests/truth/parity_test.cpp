// T12: path tracing, bidirectional path tracing and Metropolis are estimators of the same picture.
// Each scene has something that one of them could get wrong.

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "core/image/write_image.h"
#include "tests/support/temp_folder.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

struct ParityScene {
  const char* name;
  const char* text;              ///< without film, sampling, integrator
  int samples = 64;              ///< of each of path's renderings; bdpt takes half
  double relative_error = 0.02;  ///< of the picture's mean that is noticed with 99 % probability
  int max_depth = 6;
  const char* mlt_over = "bdpt";
};

void PrintTo(const ParityScene& scene, std::ostream* out) { *out << scene.name; }

constexpr int kRuns = 24;

const ParityScene kScenes[] = {
    {"room_with_area_light", R"(
camera: {look_from: [0, 1, 3.4], look_at: [0, 1, 0], fov: 40}
materials:
  white: {type: lambert, color: 0.7}
  red: {type: lambert, color: [0.6, 0.05, 0.05]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
objects:
  floor: {shape: rectangle, size: [2, 2], material: white}
  ceiling: {shape: rectangle, size: [2, 2], transform: [{rotate_x: 180}], at: [0, 2, 0], material: white}
  back: {shape: rectangle, size: [2, 2], transform: [{rotate_x: 90}], at: [0, 1, -1], material: white}
  left: {shape: rectangle, size: [2, 2], transform: [{rotate_z: -90}], at: [-1, 1, 0], material: red}
  ball: {shape: sphere, radius: 0.4, at: [0.3, 0.4, 0], material: shiny}
  lamp: {shape: rectangle, size: [0.5, 0.5], transform: [{rotate_x: 180}], at: [0, 1.95, 0], emit: {radiance: 12}}
)"},
    {"point_and_spot", R"(
camera: {look_from: [0, 1, 3.4], look_at: [0, 0.8, 0], fov: 40}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  back: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 90}], at: [0, 1, -1], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0.3, 0.4, 0], material: white}
lights:
  a: {type: point, at: [-0.8, 1.5, 0.4], power: 40}
  b: {type: spot, at: [0.9, 1.6, 0.5], look_at: [0.2, 0, 0], angle: 35, blend: 0.4, power: 60, color: [1, 0.6, 0.3]}
)"},
    {"sky_and_sun", R"(
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 35}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  chrome: {type: conductor, metal: copper, roughness: 0.4}
objects:
  floor: {shape: disk, radius: 3, material: white}
  ball: {shape: sphere, radius: 0.6, at: [0.5, 0.6, 0], material: chrome}
  box: {shape: box, size: [0.7, 1, 0.7], at: [-0.7, 0.5, 0], material: white}
lights:
  sun: {type: sun, direction: [1, -2, -1], irradiance: 2, angle: 8}
  moon: {type: sun, direction: [-1, -1, 0], irradiance: 0.7, angle: 0}
environment: {image: jobs/quickstart/dusk.exr, strength: 0.8}
)"},
    {"glass_ball_over_a_floor", R"(
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 35}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, ior: 1.5, transmission: [0.9, 1, 0.9]}
objects:
  floor: {shape: disk, radius: 2, material: white}
  ball: {shape: sphere, radius: 0.6, at: [0, 0.7, 0], material: glass}
  lamp: {shape: sphere, radius: 0.5, at: [0.5, 2.6, 0], emit: {radiance: 8}}
)",
     256, 0.03},
    {"hdr_sun_through_a_dielectric", R"(
camera: {look_from: [0, 1.4, 4], look_at: [0, 0.5, 0], fov: 35}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, ior: 1.5}
objects:
  floor: {shape: disk, radius: 2, material: white}
  ball: {shape: sphere, radius: 0.6, at: [-0.4, 0.7, 0], material: glass}
  block: {shape: box, size: [0.5, 0.9, 0.5], transform: [{rotate_y: 30}], at: [0.8, 0.5, 0], material: glass}
environment: {image: sun.exr}
)",
     192, 0.05},
    {"rough_glass_and_a_mix", R"(
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 35}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  frosted: {type: dielectric, ior: 1.5, roughness: 0.5}
  mirror: {type: mirror}
  half: {type: mix, first: white, second: mirror, amount: 0.5}
  pane: {type: thin-dielectric, ior: 1.5}
objects:
  floor: {shape: disk, radius: 2, material: half}
  ball: {shape: sphere, radius: 0.5, at: [-0.6, 0.6, 0], material: frosted}
  plate: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 80}], at: [0.6, 0.6, 0.5], material: pane}
  wall: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], at: [0.6, 0.6, -0.5], material: white}
  lamp: {shape: sphere, radius: 0.5, at: [0.5, 2.6, 0.6], emit: {radiance: 8}}
)",
     192, 0.05},
    {"bumped_gloss", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
textures:
  waves: {type: perlin3d, scale: 4, octaves: 2}
materials:
  white: {type: lambert, color: 0.7, bump: {texture: waves, height: 0.1}}
  shiny: {type: glossy, color: [0.6, 0.4, 0.2], reflectiveness: 0.5, glossiness: 0.7, bump: {texture: waves, height: 0.1}}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  ball: {shape: sphere, radius: 0.5, at: [0, 0.55, 0], material: shiny}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.8], emit: {radiance: 15}}
)"},
    {"mix_of_bumps", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
textures:
  waves: {type: perlin3d, scale: 4, octaves: 2}
materials:
  rough: {type: lambert, color: [0.8, 0.6, 0.3], bump: {texture: waves, height: 0.3}}
  smooth: {type: lambert, color: [0.2, 0.3, 0.8]}
  both: {type: mix, first: rough, second: smooth, amount: 0.3}
objects:
  floor: {shape: rectangle, size: [3, 3], material: both}
  ball: {shape: sphere, radius: 0.5, at: [0, 0.55, 0], material: both}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.8], emit: {radiance: 15}}
)"},
    {"smooth_normals_of_a_coarse_mesh", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
materials:
  white: {type: lambert, color: 0.7}
  shiny: {type: glossy, color: [0.6, 0.4, 0.2], reflectiveness: 0.5, glossiness: 0.7}
  glass: {type: dielectric, ior: 1.4, roughness: 0.4}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  ball: {mesh: tests/truth/coarse_ball.obj, normals: smooth, transform: [{scale: 0.5}], at: [-0.55, 0.5, 0], material: shiny}
  drop: {mesh: tests/truth/coarse_ball.obj, normals: smooth, transform: [{scale: 0.45}], at: [0.55, 0.5, 0], material: glass}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.8], emit: {radiance: 15}}
)",
     64, 0.02, 6, "path"},
    {"sphere_light_behind_a_null_boundary", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  ball: {shape: sphere, radius: 0.3, at: [0, 0.4, 0], material: white}
  shell: {shape: sphere, radius: 0.6, at: [0.8, 1.6, 0.3], material: air}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.3], emit: {radiance: 15}}
  glow: {shape: rectangle, size: [0.5, 0.5], transform: [{rotate_z: -90}], at: [-0.8, 0.6, 0], material: air, emit: {radiance: 3, two_sided: true}}
)"},
    {"thin_lens", R"(
camera: {look_from: [0, 1, 3], look_at: [0, 0.5, 0], fov: 45, aperture: {radius: 0.15, blades: 5}, focus: 2.5}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
objects:
  floor: {shape: rectangle, size: [6, 6], material: white}
  near: {shape: sphere, radius: 0.15, at: [0.2, 0.7, 1.6], material: white}
  far: {shape: sphere, radius: 0.5, at: [-0.7, 0.5, -1], material: white}
  lamp: {shape: sphere, radius: 0.2, at: [0.8, 1.6, 0.3], emit: {radiance: 25}}
)"},
    {"motion_blur", R"(
frames: {range: 1, fps: 24, shutter: 1}
camera: {look_from: ["= 0.2 * 24 * t", 1, 3], look_at: [0, 0.5, 0], fov: 45}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
objects:
  floor: {shape: rectangle, size: [6, 6], material: white}
  ball: {shape: sphere, radius: 0.4, at: ["= 24 * t", 0.5, 0], material: white}
  lamp: {shape: sphere, radius: 0.2, at: [0.8, "= 1.4 + 10 * t", 0.3], emit: {radiance: 25}, visible_to_camera: false}
)"},
    {"lamp_with_back_and_unseen_things", R"(
camera: {look_from: [0, 1, 3], look_at: [0, 0.7, 0], fov: 45}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  hidden: {shape: sphere, radius: 0.3, at: [0, 0.5, 1], material: white, visible_to_camera: false}
  lamp: {shape: disk, radius: 0.4, transform: [{rotate_x: 60}], at: [0, 1, 0], emit: {radiance: 9, two_sided: true}}
  tube: {shape: cylinder, radius: 0.1, height: 0.8, at: [-1, 0.2, 0], emit: {radiance: 4}, visible_to_camera: false}
environment: {color: [0.2, 0.3, 0.5], visible_to_camera: false}
)"},
    {"camera_in_coloured_fog", R"(
camera: {look_from: [0, 1, 3], look_at: [0, 0.7, 0], fov: 45}
media: {fog: {scattering: [0.3, 0.2, 0.1], absorption: [0.02, 0.05, 0.1], g: 0.5}}
atmosphere: fog
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0, 0.5, 0], material: white}
  lamp: {shape: sphere, radius: 0.25, at: [0.7, 1.7, 0.2], emit: {radiance: 15}}
)",
     96, 0.03, 4},
    {"large_lamp_in_forward_fog", R"(
camera: {look_from: [0, 0.5, 3], look_at: [0, 0.5, 0], fov: 60}
media: {fog: {scattering: 0.4, g: 0.85}}
atmosphere: fog
objects:
  lamp: {shape: sphere, radius: 0.5, at: [0, 0.5, 0], emit: {radiance: 2}, visible_to_camera: false}
)",
     96, 0.03, 3},
    {"lamp_in_a_cloud_of_noise", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
media:
  cloud: {scattering: [8, 9, 10], absorption: [0.5, 0.2, 0.1], g: 0.4, emission: [0, 0.02, 0.05], density: {noise: {scale: 3, octaves: 3}}}
materials:
  white: {type: lambert, color: 0.6}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  smoke: {shape: box, size: [1.4, 1, 1], at: [0, 0.6, 0], material: air, interior: cloud}
  lamp: {shape: sphere, radius: 0.3, at: [0.9, 1.7, 0.6], emit: {radiance: 25}}
)",
     96, 0.03},
    {"coloured_glass_over_milk", R"(
camera: {look_from: [0, 1.4, 3], look_at: [0, 0.5, 0], fov: 40}
media:
  milk: {scattering: [6, 7, 8], absorption: [0.2, 0.1, 0.05], g: 0.4}
  tint: {absorption: [0.1, 1, 2]}
materials:
  white: {type: lambert, color: 0.6}
  air: {type: "null"}
  glass: {type: dielectric, ior: 1.3}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  block: {shape: box, size: [1, 0.6, 1], at: [0, 0.32, 0], material: air, interior: milk}
  plate: {shape: box, size: [1.2, 0.15, 1.2], at: [0, 0.8, 0], material: glass, interior: tint}
  lamp: {shape: sphere, radius: 0.5, at: [0.5, 2.2, 0.8], emit: {radiance: 8}}
)",
     256, 0.03, 12},
    {"milk_in_a_glass_ball", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 30}
media:
  milk: {scattering: [4, 5, 6], absorption: [0.3, 0.1, 0.05], g: 0.5}
materials:
  white: {type: lambert, color: 0.6}
  glass: {type: dielectric, ior: 1.5}
  frosted: {type: dielectric, ior: 1.5, roughness: 0.4}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  ball: {shape: sphere, radius: 0.5, at: [-0.55, 0.6, 0], material: glass, interior: milk}
  cube: {shape: box, size: [0.8, 0.8, 0.8], at: [0.55, 0.5, 0], material: frosted, interior: milk}
  lamp: {shape: sphere, radius: 0.6, at: [0.5, 2.2, 0.8], emit: {radiance: 8}}
)",
     128, 0.06, 10},
    {"two_nested_media", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
media:
  mist: {scattering: [0.5, 0.6, 0.8], absorption: 0.05, g: 0.3}
  ink: {scattering: [1, 0.3, 0.2], absorption: [0.1, 1, 2], g: -0.3}
materials:
  white: {type: lambert, color: 0.6}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  outer: {shape: sphere, radius: 0.7, at: [0, 0.72, 0], material: air, interior: mist}
  inner: {shape: sphere, radius: 0.35, at: [0.1, 0.7, 0], material: air, interior: ink}
lights:
  key: {type: point, at: [1, 2, 1], power: 60}
  rim: {type: sun, direction: [1, -1, 1], irradiance: 1, angle: 4}
)",
     128, 0.02, 8, "path"},
    {"milk_that_overlaps_glass", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
media:
  milk: {scattering: [2, 1.5, 1], absorption: [0.1, 0.2, 0.4], g: 0.5}
  mist: {scattering: 0.3, absorption: 0.02}
materials:
  white: {type: lambert, color: 0.6}
  glass: {type: dielectric, ior: 1.5}
  milk: {type: dielectric, ior: 1.33}
  bubble: {type: dielectric, ior: 1}
  air: {type: "null"}
atmosphere: mist
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  glass: {shape: cylinder, radius: 0.5, height: 0.5, at: [0, 0.05, 0], material: glass, priority: 1}
  milk: {shape: sphere, radius: 0.45, at: [0.1, 0.7, 0], material: milk, interior: milk}
  bubble: {shape: sphere, radius: 0.15, at: [0.1, 0.85, 0.2], material: bubble, priority: 2}
  haze: {shape: sphere, radius: 0.4, at: [-0.5, 0.5, 0.2], material: air, interior: mist}
  lamp: {shape: sphere, radius: 0.9, at: [0.5, 2.5, 0.8], emit: {radiance: 5}}
)",
     24, 0.08, 6},
    {"glowing_gas", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
media:
  flame: {scattering: 0.5, absorption: [0.5, 1, 2], emission: [2, 1, 0.3]}
materials:
  white: {type: lambert, color: 0.6}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  gas: {shape: sphere, radius: 0.5, at: [0, 0.7, 0], material: air, interior: flame}
lights:
  key: {type: point, at: [1, 2, 1], power: 20}
)",
     128},
};

/// A picture of a sky with a sun: 2 x 2 pixels of 64 x 32, a thousand times as bright as the rest.
const std::string& folder_with_sun() {
  static const TempFolder folder;
  static const std::string path = [] {
    core::Image sky;
    sky.width = 64;
    sky.height = 32;
    sky.channels = {"R", "G", "B"};
    for (int y = 0; y < sky.height; ++y) {
      for (int x = 0; x < sky.width; ++x) {
        const bool sun = (x == 22 || x == 23) && (y == 8 || y == 9);
        const core::Rgb c = sun ? core::Rgb(300, 270, 200) : core::Rgb(0.15F, 0.25F, 0.4F);
        sky.data.insert(sky.data.end(), {c.x, c.y, c.z});
      }
    }
    EXPECT_TRUE(core::write_exr(folder.file("sun.exr"), sky).ok());
    return folder.path().string();
  }();
  return path;
}

YamlScene scene_with(const ParityScene& scene, const std::string& integrator, int samples) {
  const bool sun = std::string(scene.text).find("sun.exr") != std::string::npos;
  return YamlScene(
      "hyades: 1\nname: parity\nfilm: {size: [24, 18], filter: {type: box, radius: 0.5}}\n"
      "sampling: {samples: " +
          std::to_string(samples) + ", seed: 11}\nintegrator: {type: " + integrator +
          ", max_depth: " + std::to_string(scene.max_depth) + "}\n" + scene.text,
      1, {}, sun ? folder_with_sun() : ".");
}

class Parity : public testing::TestWithParam<ParityScene> {};

// Metropolis has most of its error in common to all of a picture, from the samples that its chains
// begin with: a larger one of the mean is noticed.
TEST_P(Parity, PathBdptAndMltAgree) {
  const ParityScene& scene = GetParam();
  Promise promise{.significance = 0.01,
                  .tests = 3 * 2 * static_cast<int>(std::size(kScenes)),
                  .relative_error = scene.relative_error,
                  .power = 0.99};
  const Replicates path = render_replicates(scene_with(scene, "path", scene.samples), kRuns, 6);
  {
    SCOPED_TRACE("bdpt");
    const YamlScene other = scene_with(scene, "bdpt", scene.samples / 2);
    expect_same_picture(path, render_replicates(other, kRuns, 6), promise);
  }
  {
    SCOPED_TRACE("mlt over " + std::string(scene.mlt_over));
    promise.relative_error *= 3.0;
    const YamlScene other =
        scene_with(scene, "mlt, over: " + std::string(scene.mlt_over), scene.samples);
    expect_same_picture(path, render_replicates(other, kRuns, 6), promise);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Parity, testing::ValuesIn(kScenes),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace hyades::test
