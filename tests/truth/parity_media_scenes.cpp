#include "tests/truth/parity_scenes.h"

namespace hyades::test {

std::vector<ParityScene> media_parity_scenes() {
  return {
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
  cloud: {scattering: [8, 9, 10], absorption: [0.5, 0.2, 0.1], g: 0.4, emission: [0, 0.4, 1], density: {noise: {scale: 3, octaves: 3}}}
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
}

}  // namespace hyades::test
