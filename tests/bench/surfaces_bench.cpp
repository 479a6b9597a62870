// What materials cost in pictures: a closed room around a mesh of 100,000 triangles, all of it
// diffuse, against the same of principled surfaces with textures. Rounds take turns and ratios of
// rounds are quoted, because machines are noisy.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/base/machine.h"
#include "core/job/parse.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace {

using namespace hyades::core;

constexpr const char* kRoom = R"(
hyades: 1
name: bench
film: {size: [256, 256], filter: box}
sampling: {samples: 16, seed: 1}
integrator: {type: path, max_depth: 8}
camera: {look_from: [4.2, 4.6, 7.2], look_at: [0, 0.1, 0], fov: 36}
textures:
  color: {type: image, file: jobs/quickstart/dusk.exr, scale: 3}
  marble: {type: fbm3d, a: 0.2, b: 0.6, scale: 2}
objects:
  knot: {mesh: jobs/mesh-100k/knot.ply, material: knot}
  room: {shape: box, size: [18, 18, 18], material: room}
  lamp: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 180}], at: [0, 8.9, 0], emit: {radiance: 20}}
)";

struct Variant {
  const char* name;
  const char* materials;
};

constexpr Variant kVariants[] = {
    {"diffuse", R"(materials:
  knot: {type: lambert, color: 0.75}
  room: {type: lambert, color: 0.75}
)"},
    {"principled", R"(materials:
  knot: {type: principled, base_color: 0.75, roughness: 0.4}
  room: {type: principled, base_color: 0.75, roughness: 0.4}
)"},
    {"principled, textured", R"(materials:
  knot: {type: principled, base_color: [0.8, 0.75, 0.7], roughness: marble, metallic: 0.3}
  room: {type: principled, base_color: color, roughness: 0.4, specular: 0.4}
)"},
    {"principled, all of it", R"(materials:
  knot: {type: principled, base_color: 0.75, roughness: marble, metallic: 0.3, coat: 0.5, sheen: 0.3, anisotropic: 0.5}
  room: {type: principled, base_color: color, roughness: 0.4, coat: 0.5, sheen: 0.3}
)"},
};

class Renderer {
 public:
  explicit Renderer(const Variant& variant) {
    Diagnostics diagnostics;
    job_ = parse_job(std::string(kRoom) + variant.materials, "bench.yaml", *assets_, diagnostics);
    if (!diagnostics.empty()) {
      std::fprintf(stderr, "%s\nrun the benchmark from the repository's root\n",
                   diagnostics.to_string().c_str());
      std::exit(1);
    }
    auto scene = build_scene(job_, 1, cache_);
    if (!scene) {
      std::fprintf(stderr, "%s\n", scene.error().message.c_str());
      std::exit(1);
    }
    renderer_ = std::make_unique<FrameRenderer>(*scene, job_, 1, LayerSet{});
  }

  /// CPU seconds of a path of a sixteenth of the picture, spread over it.
  double seconds_per_path() const {
    const double begin = thread_seconds();
    uint64_t paths = 0;
    for (int i = 0; i < 16; ++i) {
      const int x = 16 * (i * 7 % 16);
      const int y = 16 * i;
      paths += renderer_->render({1, {x, y, x + 16, y + 16}, {0, 1}}).counters.samples;
    }
    return (thread_seconds() - begin) / static_cast<double>(paths);
  }

 private:
  std::unique_ptr<AssetResolver> assets_ = make_file_resolver(".");
  Job job_;
  SceneCache cache_{*assets_};
  std::unique_ptr<FrameRenderer> renderer_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main() {
  const FpMode mode;
  std::vector<std::unique_ptr<Renderer>> renderers;
  for (const Variant& variant : kVariants) renderers.push_back(std::make_unique<Renderer>(variant));
  constexpr int kRounds = 21;
  std::vector<std::vector<double>> times(renderers.size());
  for (int round = 0; round < kRounds; ++round) {
    for (size_t i = 0; i < renderers.size(); ++i)
      times[i].push_back(renderers[i]->seconds_per_path());
  }
  for (size_t i = 0; i < renderers.size(); ++i) {
    std::vector<double> ratios;
    for (int round = 0; round < kRounds; ++round)
      ratios.push_back(times[0][round] / times[i][round]);
    std::printf("%-24s %8.0f paths/s, %3.0f %% of diffuse\n", kVariants[i].name,
                1.0 / median(times[i]), 100.0 * median(ratios));
  }
  return 0;
}
