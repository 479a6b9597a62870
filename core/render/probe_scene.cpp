#include "core/render/probe_scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/vec.h"
#include "core/geometry/curve_set.h"
#include "core/geometry/read_hair.h"

namespace hyades::core {
namespace {

/// A square of so many cells on a side.
constexpr int kWaveCells = 40;
constexpr int kSkyWidth = 64;
constexpr int kSkyHeight = 32;
constexpr int kStrands = 64;
constexpr int kStrandPoints = 4;

/// Whole numbers in thousandths, so that the text (and with it the mesh) is the same everywhere.
std::string wave_obj() {
  std::string text;
  for (int y = 0; y <= kWaveCells; ++y) {
    for (int x = 0; x <= kWaveCells; ++x) {
      const uint64_t bits = hash_combine(static_cast<uint64_t>(x), static_cast<uint64_t>(y));
      const int height = static_cast<int>(bits % 61);
      text += fmt::format("v {}e-3 {}e-3 {}e-3\n", 50 * x - 1000, height, 50 * y - 1000);
    }
  }
  const auto corner = [](int x, int y) { return y * (kWaveCells + 1) + x + 1; };
  for (int y = 0; y < kWaveCells; ++y) {
    for (int x = 0; x < kWaveCells; ++x) {
      text += fmt::format("f {} {} {} {}\n", corner(x, y), corner(x, y + 1), corner(x + 1, y + 1),
                          corner(x + 1, y));
    }
  }
  return text;
}

/// A tuft: strands that lean to all sides. Halves and quarters, so that they are the same
/// everywhere.
std::string tuft_hair() {
  StrandList tuft;
  for (int i = 0; i < kStrands; ++i) {
    const Vec2 root(static_cast<float>(i % 8) / 8.0F, static_cast<float>(i / 8) / 8.0F);
    for (int at = 0; at < kStrandPoints; ++at) {
      const float up = static_cast<float>(at) / 4.0F;
      tuft.points.emplace_back(root.x + (root.x - 0.5F) * up * up, up, root.y + 0.25F * up);
      tuft.radii.push_back(0.03125F);
    }
    tuft.sizes.push_back(kStrandPoints);
  }
  const Bytes bytes = hair_bytes(tuft);
  return {bytes.chars(), bytes.size()};
}

/// Copies on a slope.
std::string crowd_ply() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 36\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\nproperty float scale\nend_header\n";
  for (int i = 0; i < 36; ++i) {
    text += fmt::format("{}e-2 {}e-2 {}e-2 {}e-2\n", 40 * (i % 6), 10 + i, 30 * (i / 6), 50 + i);
  }
  return text;
}

/// A Radiance picture without runs: dim from below, bright from above, one bright spot.
std::string sky_hdr() {
  std::string bytes =
      fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", kSkyHeight, kSkyWidth);
  for (int y = 0; y < kSkyHeight; ++y) {
    for (int x = 0; x < kSkyWidth; ++x) {
      const bool sun = y == 7 && x == 20;
      const int level = 40 + (kSkyHeight - y) * 5 + (x * 37 + y * 101) % 29;
      for (const int part : {level, level - 10, level + 20, sun ? 136 : 128}) {
        bytes.push_back(static_cast<char>(part));
      }
    }
  }
  return bytes;
}

class MemoryResolver : public AssetResolver {
 public:
  explicit MemoryResolver(std::map<std::string, std::string> files) {
    for (auto& [name, content] : files) {
      files_[name] = std::make_shared<const std::string>(std::move(content));
    }
  }

  Result<Bytes> open(const std::string& reference, const std::string& from) override {
    const auto found = files_.find(resolve_reference(reference, from));
    if (found == files_.end()) return Error{reference + ": no such file"};
    return Bytes{found->second, std::as_bytes(std::span(*found->second))};
  }

 private:
  std::map<std::string, std::shared_ptr<const std::string>> files_;
};

}  // namespace

const char* const kProbeJob = R"(
hyades: 1
name: class-probe
frames: {range: 1-2, fps: 24, shutter: 0.5}
film: {size: [48, 32], filter: {type: blackman-harris, radius: 1.5}}
sampling: {samples: 12, seed: 20}
integrator: {type: path, max_depth: 8}
camera: {look_from: [0.4, 2.1, 4.6], look_at: [0, 0.5, 0], fov: 38, aperture: {radius: 0.03, blades: 7}}
textures:
  swell: {type: fbm4d, scale: 2.3, octaves: 3, time: "= 0.6 + t"}
  grain: {type: perlin3d, scale: 5, a: [0.1, 0.2, 0.4], b: [0.9, 0.7, 0.5]}
  tiles: {type: checker, scale: 9, a: grain, b: 0.1}
  paper: {type: image, file: sky.hdr, scale: 3, wrap: mirror}
  faded: {type: scale, input: paper, factor: 0.4}
materials:
  floor: {type: glossy, color: tiles, reflectiveness: 0.3, glossiness: 0.8}
  gold: {type: conductor, metal: gold, roughness: 0.3, bump: {texture: swell, height: 0.08}}
  glass: {type: dielectric, ior: 1.5}
  frost: {type: dielectric, ior: 1.4, roughness: 0.3}
  card: {type: lambert, color: faded}
  red: {type: lambert, color: [0.8, 0.1, 0.05]}
  skin: {type: dielectric, ior: 1.4, subsurface: {color: [0.9, 0.6, 0.4], radius: 0.05}}
  fur: {type: hair, color: [0.4, 0.25, 0.1]}
  air: {type: "null"}
  blend: {type: mix, first: red, second: gold, amount: 0.4}
media:
  milk: {scattering: [6, 8, 10], absorption: [0.3, 0.1, 0.05], g: 0.4}
  smoke: {albedo: 0.8, scale: 5, g: -0.2, density: {noise: {scale: 3, octaves: 2, fade: 0.4}}}
groups:
  pebble: {objects: {stone: {shape: sphere, radius: 0.12, material: gold}, cap: {mesh: wave.obj, material: red, transform: [{scale: 0.1}]}}}
objects:
  crowd: {instance: pebble, places: crowd.ply, at: [-2.6, 0.1, -2.6]}
  tuft: {curves: tuft.hair, material: fur, transform: [{scale: 0.5}], at: [-1.9, 0.1, 0.4]}
  cloud: {shape: box, size: [1.2, 0.9, 0.8], material: air, interior: smoke, at: [1.9, 0.6, -1.2]}
  nose: {shape: sphere, radius: 0.3, material: skin, at: [-0.3, 0.3, 1.5]}
  hills: {mesh: wave.obj, material: floor, transform: [{scale: [3, 1, 3]}]}
  flag: {mesh: wave.obj, material: card, transform: [{scale: 0.6}, {rotate_x: 70}, {rotate_y: "= 100 * t"}], at: ["= -1.4 + 3 * t", 1.0, -0.6]}
  sheet: {mesh: wave.obj, material: red, transform: [{scale: 0.3}, {rotate_z: 40}], at: [1.5, 1.4, 0]}
  plate: {shape: rectangle, size: [1, 1], material: card, transform: [{rotate_x: 30}], at: [-1.2, 0.4, 1]}
  plate_again: {shape: rectangle, size: [1, 1], material: red, transform: [{rotate_x: 30}], at: [-1.2, 0.4, 1]}
  cube: {shape: box, size: [0.5, 0.5, 0.5], material: blend, at: [0.2, 0.3, 1.2]}
  cube_again: {shape: box, size: [0.5, 0.5, 0.5], material: red, at: [0.2, 0.3, 1.2]}
  ball: {shape: sphere, radius: 0.55, material: gold, at: [0, "= 0.7 + 2 * t", -0.2]}
  drop: {shape: sphere, radius: 0.4, material: glass, interior: milk, at: [0.95, 0.5, 0.9]}
  ice: {shape: cylinder, radius: 0.25, height: 0.7, material: frost, at: [-0.7, 0.1, 0.6]}
  coin: {shape: disk, radius: 0.3, material: gold, transform: [{rotate_z: 55}], at: [1.5, 0.5, 0.2]}
  lamp: {shape: sphere, radius: 0.3, at: [-2.5, 3.5, 2], emit: {color: 3400K, power: 200}}
environment: {image: sky.hdr, rotate_y: 25, strength: 0.7}
)";

std::unique_ptr<AssetResolver> make_probe_assets() {
  return std::make_unique<MemoryResolver>(
      std::map<std::string, std::string>{{"wave.obj", wave_obj()},
                                         {"sky.hdr", sky_hdr()},
                                         {"tuft.hair", tuft_hair()},
                                         {"crowd.ply", crowd_ply()}});
}

}  // namespace hyades::core
