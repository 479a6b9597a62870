// A generated OBJ file of two million triangles, whole and cut into its materials, against what
// has to be done in any case: reading the bytes, and the same mesh out of a binary PLY file.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <numeric>
#include <string>

#include "core/geometry/read_mesh.h"
#include "core/geometry/write_ply.h"

namespace {

using namespace hyades::core;

constexpr int kSide = 1001;  ///< vertices along a side: 1000 x 1000 x 2 triangles
constexpr int kMaterials = 300;

/// A wavy sheet with normals and uv, whose numbers differ as exporters write them: uv row by row
/// backwards, one normal for each column. `materials` take turns in runs of rows.
std::string sheet(int materials) {
  std::string text = "mtllib sheet.mtl\n";
  auto out = std::back_inserter(text);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double u = i / (kSide - 1.0);
      fmt::format_to(out, "v {:.6f} {:.6f} {:.6f}\n", u, 0.02 * std::sin(40.0 * u),
                     j / (kSide - 1.0));
    }
  }
  for (int j = kSide - 1; j >= 0; --j) {
    for (int i = 0; i < kSide; ++i) {
      fmt::format_to(out, "vt {:.6f} {:.6f}\n", i / (kSide - 1.0), j / (kSide - 1.0));
    }
  }
  for (int i = 0; i < kSide; ++i) {
    const double slope = 0.8 * std::cos(40.0 * i / (kSide - 1.0));
    const double length = std::sqrt(1.0 + slope * slope);
    fmt::format_to(out, "vn {:.4f} {:.4f} 0\n", -slope / length, 1.0 / length);
  }
  const auto corner = [&](int i, int j) {
    fmt::format_to(out, " {}/{}/{}", j * kSide + i + 1, (kSide - 1 - j) * kSide + i + 1, i + 1);
  };
  for (int j = 0; j + 1 < kSide; ++j) {
    if (materials > 1) fmt::format_to(out, "usemtl material {}\n", j % materials);
    for (int i = 0; i + 1 < kSide; ++i) {
      text += "f";
      corner(i, j), corner(i, j + 1), corner(i + 1, j);
      text += "\nf";
      corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1);
      text += "\n";
    }
  }
  return text;
}

/// The files on disk.
struct Setup {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hyades-obj-bench-" + std::to_string(getpid()));
  std::unique_ptr<AssetResolver> files;

  Setup() {
    std::filesystem::create_directories(folder);
    write("one.obj", sheet(1));
    write("many.obj", sheet(kMaterials));
    files = make_file_resolver(folder.string());
    const Bytes ply = ply_bytes(**read_mesh(*files, "one.obj"));
    write("one.ply", {ply.chars(), ply.size()});
  }
  ~Setup() { std::filesystem::remove_all(folder); }
  void write(const char* name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
};

Setup& setup() {
  static Setup once;
  return once;
}

void count_bytes(benchmark::State& state, const char* file) {
  const auto size = static_cast<int64_t>(std::filesystem::file_size(setup().folder / file));
  state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) * size);
}

void add_up_bytes(benchmark::State& state) {
  setup();
  for (auto _ : state) {
    const Bytes bytes = *setup().files->open("one.obj");
    benchmark::DoNotOptimize(
        std::accumulate(bytes.chars(), bytes.chars() + bytes.size(), int64_t{0}));
  }
  count_bytes(state, "one.obj");
}
BENCHMARK(add_up_bytes)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void read_whole(benchmark::State& state, const char* file) {
  setup();
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(*setup().files, file));
  count_bytes(state, file);
}
BENCHMARK_CAPTURE(read_whole, ply, "one.ply")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(read_whole, obj, "one.obj")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void read_parts(benchmark::State& state, const char* file) {
  setup();
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh_parts(*setup().files, file));
  count_bytes(state, file);
}
BENCHMARK_CAPTURE(read_parts, one, "one.obj")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(read_parts, three_hundred, "many.obj")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
