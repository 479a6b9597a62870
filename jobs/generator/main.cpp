// Makes the gallery's own assets: `make-gallery-assets FOLDER` writes them below FOLDER (the
// repository's jobs/). Everything follows from formulas in this folder, so every asset can be made
// again.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

#include "core/base/atomic_file.h"
#include "core/image/write_image.h"
#include "jobs/generator/figure.h"
#include "jobs/generator/images.h"
#include "jobs/generator/lamplighter.h"
#include "jobs/generator/scatter.h"
#include "jobs/generator/shapes.h"
#include "jobs/generator/sky.h"

namespace {

using namespace hyades::gallery;

/// A wine glass: outer wall up from the foot, rim, inner wall down to the bowl's bottom.
Mesh make_goblet() {
  return make_lathe({{0.0F, 0.0F},
                     {0.34F, 0.0F},
                     {0.36F, 0.02F},
                     {0.2F, 0.045F},
                     {0.05F, 0.09F},
                     {0.04F, 0.4F},
                     {0.06F, 0.62F},
                     {0.25F, 0.74F},
                     {0.38F, 0.98F},
                     {0.36F, 1.3F},
                     {0.3F, 1.5F},
                     {0.29F, 1.51F},
                     {0.28F, 1.5F},
                     {0.335F, 1.3F},
                     {0.355F, 0.98F},
                     {0.23F, 0.77F},
                     {0.05F, 0.68F},
                     {0.0F, 0.675F}},
                    7, 80);
}

/// Wine in that goblet: it reaches half-way into the wall, so that the glass, of higher priority,
/// bounds it; only its top stands free.
Mesh make_wine() {
  return make_lathe({{0.0F, 0.66F},
                     {0.05F, 0.663F},
                     {0.24F, 0.755F},
                     {0.367F, 0.98F},
                     {0.369F, 1.09F},
                     {0.36F, 1.098F},
                     {0.345F, 1.092F},
                     {0.3F, 1.09F},
                     {0.0F, 1.09F}},
                    6, 80);
}

/// A ring around y whose middle line has a radius of 1.
Mesh make_ring() {
  std::vector<Vec2> circle;
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const float a = 6.2831853F * static_cast<float>(i % kSteps) / static_cast<float>(kSteps);
    circle.emplace_back(1.0F + 0.09F * std::cos(a), 0.09F * std::sin(a));
  }
  return make_lathe(circle, 1, 96);
}

/// A ring around y as armillary spheres have them: a flat band of radius 1.
Mesh make_band() {
  constexpr float kWidth = 0.05F, kThickness = 0.012F;
  const Vec2 corners[] = {{1.0F - kThickness, -kWidth},
                          {1.0F + kThickness, -kWidth},
                          {1.0F + kThickness, kWidth},
                          {1.0F - kThickness, kWidth}};
  std::vector<Vec2> profile;
  for (int i = 0; i <= 4; ++i) {
    const Vec2 from = corners[i % 4];
    const Vec2 to = corners[(i + 1) % 4];
    // Points close to the corners keep them sharp for a smooth curve.
    for (const float u : {0.02F, 0.5F, 0.98F}) {
      if (i < 4) profile.push_back(from + u * (to - from));
    }
  }
  profile.push_back(profile.front());
  return make_lathe(profile, 2, 128);
}

/// A vase with a waist, hollow.
Mesh make_vase() {
  return make_lathe({{0.0F, 0.0F},
                     {0.4F, 0.0F},
                     {0.44F, 0.03F},
                     {0.62F, 0.4F},
                     {0.6F, 0.8F},
                     {0.3F, 1.3F},
                     {0.24F, 1.5F},
                     {0.36F, 1.72F},
                     {0.345F, 1.73F},
                     {0.2F, 1.5F},
                     {0.26F, 1.3F},
                     {0.55F, 0.8F},
                     {0.57F, 0.4F},
                     {0.38F, 0.06F},
                     {0.0F, 0.05F}},
                    6, 96);
}

/// A tumbler's inner wall, in centimetres: its radius at a height.
float tumbler_bore(float height) { return 1.9F + (height - 0.9F) * 0.085F; }

/// A tumbler in centimetres, 8 high: thick bottom, wall of 2.2 mm, round rim.
Mesh make_tumbler() {
  constexpr float kHeight = 8.0F, kWall = 0.22F, kRim = 0.109F;
  return make_lathe(round_corners({{{0.0F, 0.0F}},
                                   {{tumbler_bore(0.0F) + kWall, 0.0F}, 0.3F},
                                   {{tumbler_bore(kHeight) + kWall, kHeight}, kRim},
                                   {{tumbler_bore(kHeight), kHeight}, kRim},
                                   {{tumbler_bore(0.9F), 0.9F}, 0.5F},
                                   {{0.0F, 0.9F}}},
                                  10),
                    1, 96);
}

/// What is poured into the tumbler up to a height [cm]. It reaches half-way into wall and bottom,
/// so that the glass, of higher priority, bounds it; its surface climbs the wall as water does, by
/// a height that falls off over the capillary length of 2.7 mm.
Mesh make_drink(float level) {
  constexpr float kReach = 0.1F, kClimb = 0.2F, kCapillary = 0.27F;
  std::vector<Vec2> profile = {{0.0F, 0.5F}, {tumbler_bore(0.5F) + kReach, 0.5F}};
  const float bore = tumbler_bore(level);
  constexpr int kSteps = 14;
  for (int i = -2; i <= kSteps; ++i) {
    // Close together where the surface is steep.
    const float u = static_cast<float>(i) / static_cast<float>(kSteps);
    const float inward = i < 0 ? static_cast<float>(i) * 0.5F * kReach : bore * u * u;
    profile.emplace_back(bore - inward, level + kClimb * std::exp(-inward / kCapillary));
  }
  return make_lathe(profile, 1, 96);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make-gallery-assets FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const auto mesh = [&](const char* name, const Mesh& made, const char* comment) {
    const std::filesystem::path path = folder / name;
    std::filesystem::create_directories(path.parent_path());
    std::printf("%s: %zu triangles\n", path.c_str(), made.triangles.size());
    return write_ply(path.string(), made, comment);
  };
  // Of what is untextured the file need not carry uvs.
  const auto without_uvs = [](Mesh made) {
    made.uvs.clear();
    return made;
  };
  bool good = true;
  good &= mesh("mesh-100k/knot.ply",
               without_uvs(make_knot({.p = 2,
                                      .q = 3,
                                      .radius = 0.42F,
                                      .lobes = 5,
                                      .ridge = 0.16F,
                                      .twist = 18,
                                      .along = 625,
                                      .around = 80})),
               "torus knot (2,3) with spiral ridges, made by jobs/generator");
  good &= mesh("quickstart/knot.ply",
               make_knot({.p = 2, .q = 3, .radius = 0.4F, .along = 300, .around = 32}),
               "torus knot (2,3), made by jobs/generator");
  good &= mesh("glass-caustics/goblet.ply", make_goblet(),
               "wine glass, surface of revolution, made by jobs/generator");
  good &= mesh("glass-caustics/wine.ply", without_uvs(make_wine()),
               "wine in goblet.ply, surface of revolution, made by jobs/generator");
  good &= mesh("god-rays/ring.ply", without_uvs(make_ring()), "ring, made by jobs/generator");
  good &= mesh("quickstart/vase.ply", make_vase(),
               "vase, surface of revolution, made by jobs/generator");
  good &= mesh("media/tumbler.ply", without_uvs(make_tumbler()),
               "tumbler in centimetres, surface of revolution, made by jobs/generator");
  good &= mesh("media/juice.ply", without_uvs(make_drink(6.4F)),
               "what is poured into tumbler.ply, made by jobs/generator");
  good &= mesh("media/milk.ply", without_uvs(make_drink(5.2F)),
               "what is poured into tumbler.ply, made by jobs/generator");

  good &= mesh("atlas/atlas.ply", make_atlas(0.013F),
               "a kneeling man with arms raised, made by jobs/generator");

  good &= mesh("atlas/band.ply", without_uvs(make_band()), "flat ring, made by jobs/generator");

  const auto text = [&](const char* name, const std::string& made) {
    const std::filesystem::path path = folder / name;
    std::filesystem::create_directories(path.parent_path());
    return hyades::core::write_file(path.string(), std::as_bytes(std::span(made))).ok();
  };
  good &= text("lamplighter/lamplighter.glb", make_lamplighter());
  good &= text("lanterns/flock.yaml", lanterns());
  good &= text("leaves/spray.yaml", spray_of_leaves());

  const auto png = [&](const char* name, const hyades::core::Image& made) {
    const std::filesystem::path path = folder / name;
    std::filesystem::create_directories(path.parent_path());
    return hyades::core::write_png(path.string(), made, {{"Comment", "made by jobs/generator"}})
        .ok();
  };
  good &= png("leaves/leaf.png", make_leaf(256));
  good &= png("textured/tiles.png", make_tiles(512));
  good &= png("textured/tile_normals.png", make_tile_normals(512));

  const auto sky = hyades::core::write_exr(
      (folder / "quickstart/dusk.exr").string(),
      make_sky({.sun_elevation = 0.22F, .sun_azimuth = 2.2F, .sun_radius = 0.035F}),
      {{"comment", "procedural evening sky with clouds of fBm noise, made by jobs/generator"}},
      true);
  if (!sky) std::fprintf(stderr, "%s\n", sky.error().message.c_str());
  return good && sky.ok() ? 0 : 1;
}
