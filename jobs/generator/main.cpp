// Makes the gallery's own assets: `make-gallery-assets FOLDER` writes them below FOLDER (the
// repository's jobs/). Everything follows from formulas in this folder, so every asset can be made
// again.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/image/write_image.h"
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
  bool good = true;
  Mesh ridged = make_knot({.p = 2,
                           .q = 3,
                           .radius = 0.42F,
                           .lobes = 5,
                           .ridge = 0.16F,
                           .twist = 18,
                           .along = 625,
                           .around = 80});
  ridged.uvs.clear();  // diffuse and untextured: the file need not carry them
  good &= mesh("mesh-100k/knot.ply", ridged,
               "torus knot (2,3) with spiral ridges, made by jobs/generator");
  good &= mesh("quickstart/knot.ply",
               make_knot({.p = 2, .q = 3, .radius = 0.4F, .along = 300, .around = 32}),
               "torus knot (2,3), made by jobs/generator");
  good &= mesh("glass-caustics/goblet.ply", make_goblet(),
               "wine glass, surface of revolution, made by jobs/generator");
  good &= mesh("quickstart/vase.ply", make_vase(),
               "vase, surface of revolution, made by jobs/generator");

  const auto sky = make_sky({.width = 512, .sun_elevation = 0.22F, .sun_azimuth = 2.2F});
  const auto written = hyades::core::write_exr(
      (folder / "quickstart/dusk.exr").string(), sky,
      {{"comment", "procedural evening sky with clouds of fBm noise, made by jobs/generator"}},
      true);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return good && written ? 0 : 1;
}
