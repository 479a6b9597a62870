#include "tests/truth/parity_scenes.h"

#include <string>

namespace hyades::test {
namespace {

/// 480 lamps of seven kinds, a sky and a sun: pedestals in rows with lamps of all shapes on them,
/// some with pictures, and bulbs and spots between.
std::string many_lights() {
  std::string text = R"(
camera: {look_from: [0, 3, 7], look_at: [0, 0.3, 0], fov: 50}
textures:
  waves: {type: perlin3d, a: [0.1, 0.5, 1], b: [1, 0.5, 0.1], scale: 9}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
groups:
  lamps:
    objects:
      globe: {shape: sphere, radius: 0.06, at: [0, 0.2, 0], emit: {color: waves, radiance: 4}}
      sheet: {shape: rectangle, size: [0.1, 0.2], transform: [{rotate_z: 60}], at: [0.3, 0.25, 0], emit: {color: [1, 0.6, 0.3], radiance: 3}}
      plate: {shape: disk, radius: 0.08, transform: [{rotate_x: 150}], at: [0, 0.4, 0.3], emit: {radiance: 5, two_sided: true}}
      tube: {shape: cylinder, radius: 0.02, height: 0.3, caps: false, at: [0.3, 0.05, 0.3], emit: {color: [0.3, 0.5, 1], power: 0.2}}
      cube: {shape: box, size: [0.08, 0.08, 0.08], at: [0.15, 0.05, 0.15], emit: {color: waves, radiance: 2}}
environment: {color: [0.02, 0.03, 0.05]}
objects:
  floor: {shape: rectangle, size: [9, 9], material: white}
  ball: {shape: sphere, radius: 0.5, at: [0.1, 0.9, 0.1], material: shiny}
  wall: {shape: rectangle, size: [3, 1], transform: [{rotate_x: 90}], at: [0, 0.5, -2], material: white}
)";
  std::string lights =
      "lights:\n  moon: {type: sun, direction: [1, -2, 0.5], irradiance: 0.1, angle: 3}\n";
  for (int i = 0; i < 80; ++i) {
    const double x = 0.9 * (i % 10) - 4.2;
    const double z = 0.9 * (i / 10) - 3.8;
    const std::string place = std::to_string(x) + ", 0, " + std::to_string(z);
    text += "  lamps_" + std::to_string(i) +
            ": {instance: lamps, transform: [{rotate_y: " + std::to_string(37 * i) + "}], at: [" +
            place + "]}\n";
    const std::string above = std::to_string(x) + ", 0.6, " + std::to_string(z + 0.4);
    lights += "  bulb_" + std::to_string(i) + ": {at: [" + above + "], " +
              (i % 2 == 0 ? "type: point, power: 0.4}\n"
                          : "type: spot, power: 1, look_at: [" + place + "], angle: 40}\n");
  }
  return text + lights;
}

}  // namespace

std::vector<ParityScene> solid_parity_scenes() {
  static const std::string kManyLights = many_lights();
  return {
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
      {"hair", R"(
camera: {look_from: [0, 1.2, 3.4], look_at: [0, 0.8, 0], fov: 40}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  blond: {type: hair, eumelanin: 0.2, roughness: 0.4, radial_roughness: 0.5}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  head: {shape: sphere, radius: 0.5, at: [0, 0.9, 0], material: white}
  fur: {curves: fur.hair, at: [0, 0.9, 0], material: blond}
  lamp: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 180}], at: [0.6, 2.2, 0.5], emit: {radiance: 8}}
environment: {color: [0.1, 0.15, 0.2]}
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
      {"lights_with_pictures", R"(
camera: {look_from: [0, 1, 3.4], look_at: [0, 0.8, 0], fov: 40}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  glass: {type: dielectric, ior: 1.5, roughness: 0.4}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  back: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 90}], at: [0, 1, -1], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0.3, 0.4, 0], material: glass}
lights:
  film: {type: projector, image: board.png, at: [-0.8, 1.5, 1.4], look_at: [0.2, 0.7, -1], up: [0.3, 1, 0], fov: 50, power: 150}
  bulb: {type: point, image: board.png, at: [0.9, 1.6, 0.5], power: 30, color: [1, 0.6, 0.3], transform: [{rotate_y: 30}]}
)",
       256, 0.03},
      {"lamps_with_sizes_and_a_spread", R"(
camera: {look_from: [0, 1, 3.4], look_at: [0, 0.8, 0], fov: 40}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  back: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 90}], at: [0, 1, -1], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0.3, 0.4, 0], material: shiny}
  softbox: {shape: rectangle, size: [0.6, 0.4], transform: [{rotate_x: 180}], at: [-0.6, 1.9, 0], emit: {power: 30, spread: 70}}
lights:
  spot: {type: spot, radius: 0.15, at: [0.9, 1.6, 0.5], look_at: [0.2, 0, 0], angle: 35, blend: 0.4, power: 60, color: [1, 0.6, 0.3]}
  bulb: {type: point, radius: 0.1, at: [-0.9, 0.5, 0.6], power: 5}
  slide: {type: projector, radius: 0.05, image: board.png, at: [-0.8, 1.5, 1.4], look_at: [0.2, 0.7, -1], fov: 50, power: 90}
)",
       256, 0.03},
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
  resin: {type: dielectric, ior: 1.5, roughness: 0.4, scale_radiance: false}
  mirror: {type: mirror}
  half: {type: mix, first: white, second: mirror, amount: 0.5}
  pane: {type: thin-dielectric, ior: 1.5}
objects:
  floor: {shape: disk, radius: 2, material: half}
  ball: {shape: sphere, radius: 0.5, at: [-0.6, 0.6, 0], material: frosted}
  plate: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 80}], at: [0.6, 0.6, 0.5], material: pane}
  bulb: {shape: sphere, radius: 0.2, at: [0, 0.25, 0.7], material: resin}
  glow: {shape: sphere, radius: 0.1, at: [0, 0.25, 0.7], emit: {radiance: 4}}
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
      {"principled_things", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
textures:
  cells: {type: checker, a: 0.15, b: 0.7, scale: 6}
  waves: {type: perlin3d, a: [0.2, 0.5, 0.3], b: [0.9, 0.6, 0.3], scale: 4}
materials:
  floor: {type: coat, roughness: 0.4, color: [1, 0.9, 0.7], base: wood}
  wood: {type: lambert, color: waves, roughness: 0.5}
  paint: {type: principled, base_color: waves, roughness: cells, metallic: 0.3, anisotropic: 0.6, sheen: 0.5}
  jade: {type: principled, base_color: [0.4, 0.8, 0.6], roughness: 0.5, transmission: 0.5, coat: 0.5, coat_roughness: 0.3}
  leaf: {type: principled, base_color: [0.3, 0.6, 0.1], thin_walled: true, diffuse_transmission: 0.5, transmission: 0.2}
  sides: {type: two-sided, front: velvet, back: copper}
  velvet: {type: sheen, base: wood, color: [0.8, 0.6, 1]}
  copper: {type: conductor, color: [0.9, 0.6, 0.5], edge: 0.7, roughness: 0.5}
objects:
  floor: {shape: rectangle, size: [3, 3], material: floor}
  ball: {shape: sphere, radius: 0.4, at: [-0.6, 0.45, 0], material: paint}
  cube: {shape: box, size: [0.5, 0.5, 0.5], at: [0.5, 0.3, 0.3], material: jade}
  leaf: {shape: rectangle, size: [0.7, 0.7], transform: [{rotate_x: 20}], at: [0.1, 1.1, 0], material: leaf}
  card: {shape: rectangle, size: [0.6, 0.8], transform: [{rotate_x: 90}, {rotate_y: 40}], at: [0.1, 0.5, -0.5], material: sides}
  lamp: {shape: sphere, radius: 0.3, at: [0.6, 1.9, 0.6], emit: {radiance: 15}}
)",
       64, 0.04},
      {"strong_normal_maps", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
textures:
  dents: {type: perlin3d, a: [0.1, 0.8, 0.6], b: [0.9, 0.2, 0.8], scale: 5, octaves: 2}
materials:
  white: {type: lambert, color: 0.7, normal_map: {texture: dents, strength: 1.5}}
  shiny: {type: principled, base_color: [0.6, 0.4, 0.2], metallic: 0.5, roughness: 0.5, normal_map: {texture: dents}}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  ball: {mesh: tests/truth/coarse_ball.obj, normals: smooth, transform: [{scale: 0.5}], at: [0, 0.55, 0], material: shiny}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.8], emit: {radiance: 15}}
)",
       64, 0.02, 6, "path"},
      {"leaves_and_veils", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
textures:
  cells: {type: checker, a: 0.1, b: 0.9, scale: 6}
  waves: {type: perlin3d, scale: 5, octaves: 2}
media: {ink: {absorption: [0.3, 1, 2], scattering: 0.5}}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  leaf: {type: lambert, color: [0.2, 0.6, 0.1], opacity: cells}
  lace: {type: conductor, metal: copper, roughness: 0.4, opacity: waves}
  pane: {type: dielectric, ior: 1.3, roughness: 0.5, opacity: 0.6}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  roof: {shape: rectangle, size: [1.2, 1.2], at: [0.1, 1.1, 0.1], material: leaf}
  ball: {shape: sphere, radius: 0.35, at: [-0.6, 0.5, 0], material: lace}
  cube: {shape: box, size: [0.5, 0.5, 0.5], at: [0.5, 0.4, 0.3], material: pane, interior: ink}
  lamp: {shape: sphere, radius: 0.3, at: [0.6, 1.9, 0.6], emit: {radiance: 15}}
)",
       96, 0.04},
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
      {"steep_bumps", R"(
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.5, 0], fov: 40}
textures:
  waves: {type: perlin3d, scale: 4, octaves: 2}
materials:
  rough: {type: lambert, color: 0.7, bump: {texture: waves, height: 0.5}}
  metal: {type: conductor, metal: copper, roughness: 0.5, bump: {texture: waves, height: 0.4}}
  frost: {type: dielectric, ior: 1.4, roughness: 0.5, bump: {texture: waves, height: 0.3}}
objects:
  floor: {shape: rectangle, size: [3, 3], material: rough}
  ball: {shape: sphere, radius: 0.45, at: [-0.5, 0.5, 0], material: metal}
  drop: {shape: sphere, radius: 0.4, at: [0.55, 0.5, 0.2], material: frost}
  lamp: {shape: sphere, radius: 0.3, at: [0.8, 1.6, 0.8], emit: {radiance: 15}}
)",
       96, 0.04},
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
      {"shifted_lens", R"(
camera: {look_from: [0, 0.5, 3], look_at: [0, 0.5, 0], fov: 45, shift: [-0.3, 0.4], aperture: {radius: 0.1}, focus: 2.5}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
objects:
  floor: {shape: rectangle, size: [6, 6], material: white}
  near: {shape: sphere, radius: 0.15, at: [0.2, 0.7, 1.6], material: white}
  tower: {shape: box, size: [0.6, 4, 0.6], at: [-0.9, 2, -1], material: white}
  lamp: {shape: sphere, radius: 0.2, at: [0.5, 1.6, 0.3], emit: {radiance: 25}}
)"},
      {"orthographic_from_within_a_body", R"(
frames: {range: 1, fps: 24, shutter: 1}
camera: {type: orthographic, look_from: ["= 0.2 * 24 * t", 1, 3], look_at: [0, 0.5, 0], height: 2.4, aperture: {radius: 0.3}, focus: 3}
media:
  fog: {scattering: [0.3, 0.2, 0.1], absorption: [0.02, 0.05, 0.1], g: 0.5}
  ink: {absorption: [0.3, 1, 2], scattering: 0.3}
atmosphere: fog
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
  air: {type: "null"}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  ball: {shape: sphere, radius: 0.4, at: [0.4, 0.5, 0], material: shiny}
  jar: {shape: box, size: [1, 2, 1], at: [-0.9, 1, 2.8], material: air, interior: ink}
  lamp: {shape: sphere, radius: 0.25, at: [0.7, 1.5, 0.2], emit: {radiance: 15}}
)",
       96, 0.05, 4},
      {"panorama_with_a_wide_filter", R"(
camera: {type: equirectangular, look_from: [0, 0.9, 0], look_at: [1, 0.9, 0]}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  behind: {shape: sphere, radius: 0.5, at: [-1.2, 0.9, 0.1], material: shiny}
  above: {shape: rectangle, size: [0.8, 0.8], at: [0.1, 1.8, 0], material: white}
  lamp: {shape: sphere, radius: 0.25, at: [-0.2, 1.2, 1.2], emit: {radiance: 5}}
)",
       64, 0.06, 4, "bdpt", "type: gaussian, radius: 3"},
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
      {"many_lights", kManyLights.c_str(), 32, 0.04},
      {"lamps_with_pictures", R"(
camera: {look_from: [0, 1, 3.2], look_at: [0, 0.7, 0], fov: 45}
textures:
  panes: {type: checker, a: [4, 1, 0.2], b: [0, 0.2, 1], scale: 4}
  clouds: {type: fbm3d, a: 0, b: [1, 3, 2], scale: 3}
  spot: {type: gradient, shape: spherical, a: 8, b: 0.1, scale: 4, offset: [-1.5, -2.5]}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
  neon: {type: principled, base_color: 0.3, emission_color: clouds, emission_strength: 3}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  window: {shape: rectangle, size: [1, 1.4], transform: [{rotate_x: 90}], at: [-0.3, 1, -1], emit: {color: panes, radiance: 2}}
  screen: {shape: rectangle, size: [0.8, 0.5], transform: [{rotate_z: 90}, {rotate_y: 20}], at: [1.2, 0.4, 0], emit: {color: spot, power: 5, two_sided: true}}
  cube: {shape: box, size: [0.3, 0.3, 0.3], transform: [{rotate_y: 25}], at: [-0.9, 0.2, 0.4], emit: {color: panes, radiance: 2}}
  rock: {mesh: tests/truth/coarse_ball.obj, transform: [{scale: 0.15}], at: [0.4, 0.2, 0.8], material: neon}
  moon: {shape: sphere, radius: 0.25, at: [0.7, 1.6, 0.2], emit: {color: clouds, radiance: 5}}
  ball: {shape: sphere, radius: 0.3, at: [0, 0.4, 0.2], material: shiny}
)",
       64, 0.03},
      {"lamps_with_holes", R"(
camera: {look_from: [0, 1, 3.2], look_at: [0, 0.7, 0], fov: 45}
textures:
  cells: {type: checker, a: 0.1, b: 0.9, scale: 6}
  waves: {type: perlin3d, a: [1, 0.3, 0.1], b: [0.2, 0.5, 2], scale: 5, octaves: 2}
materials:
  white: {type: lambert, color: [0.7, 0.5, 0.3]}
  lace: {type: lambert, color: 0.5, opacity: cells}
  veil: {type: black, opacity: 0.4}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  shade: {shape: cylinder, radius: 0.3, height: 0.6, caps: false, at: [-0.6, 0.6, 0], material: lace, emit: {color: waves, power: 10, two_sided: true}}
  sheet: {shape: rectangle, size: [0.8, 0.8], transform: [{rotate_x: 120}], at: [0.5, 1.1, 0], material: veil, emit: {radiance: 4}}
  globe: {shape: sphere, radius: 0.25, at: [0.9, 0.4, 0.7], material: lace, emit: {color: waves, radiance: 4, two_sided: true}}
  ball: {shape: sphere, radius: 0.3, at: [0, 0.4, 0.2], material: white}
)",
       64, 0.03},
      {"images_at_all_their_sizes", R"(
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 35}
textures:
  far: {type: image, file: board.png, scale: 60}
  long: {type: image, file: board.png, scale: 90, filter: anisotropic}
materials:
  floor: {type: lambert, color: far}
  wall: {type: lambert, color: far, bump: {texture: long, height: 0.002}}
  shiny: {type: glossy, color: long, reflectiveness: 0.6, glossiness: 0.7}
  mirror: {type: mirror}
objects:
  floor: {shape: rectangle, size: [12, 12], material: floor}
  behind: {shape: rectangle, size: [12, 4], transform: [{rotate_x: -90}], at: [0, 2, 6], material: wall}
  ball: {shape: sphere, radius: 0.6, at: [-0.7, 0.6, 0], material: shiny}
  chrome: {shape: sphere, radius: 0.6, at: [0.7, 0.6, 0], material: mirror}
  lamp: {shape: sphere, radius: 0.6, at: [0.5, 2.6, 2], emit: {radiance: 2}}
environment: {color: 1}
)",
       64, 0.04},
  };
}

}  // namespace hyades::test
