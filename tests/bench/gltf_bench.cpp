// A generated .glb of 10 MB, from the bytes of the file to the mesh that is rendered, against what
// has to be done in any case: reading the bytes, and the mesh out of a PLY file.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/geometry/read_mesh.h"
#include "import/gltf/read_gltf.h"

namespace {

using namespace hyades::core;

/// A wavy sheet of n x n vertices with normals and uv: 32 bytes a vertex, 24 per two triangles.
std::string sheet(uint32_t n) {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<uint32_t> indices;
  for (uint32_t j = 0; j < n; ++j) {
    for (uint32_t i = 0; i < n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n - 1);
      const float v = static_cast<float>(j) / static_cast<float>(n - 1);
      positions.insert(positions.end(), {u, 0.02F * std::sin(40.0F * u), v});
      const float slope = 0.8F * std::cos(40.0F * u);
      const float length = std::sqrt(1.0F + slope * slope);
      normals.insert(normals.end(), {-slope / length, 1.0F / length, 0.0F});
      uvs.insert(uvs.end(), {u, v});
      if (i + 1 < n && j + 1 < n) {
        const uint32_t a = j * n + i;
        indices.insert(indices.end(), {a, a + n, a + 1, a + 1, a + n, a + n + 1});
      }
    }
  }
  std::string buffer;
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  const auto add = [&](const void* data, size_t size, size_t count, int component,
                       const char* type) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    buffer.append(static_cast<const char*>(data), size);
  };
  add(positions.data(), positions.size() * 4, positions.size() / 3, 5126, "VEC3");
  json["accessors"][0]["min"] = {0, -0.02, 0};
  json["accessors"][0]["max"] = {1, 0.02, 1};
  add(normals.data(), normals.size() * 4, normals.size() / 3, 5126, "VEC3");
  add(uvs.data(), uvs.size() * 4, uvs.size() / 2, 5126, "VEC2");
  add(indices.data(), indices.size() * 4, indices.size(), 5125, "SCALAR");
  json["buffers"] = {{{"byteLength", buffer.size()}}};
  json["meshes"] = {
      {{"name", "sheet"},
       {"primitives",
        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}}}}};
  json["nodes"] = {{{"mesh", 0}}};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  const auto word = [&](size_t number) {
    const auto low = static_cast<uint32_t>(number);
    out.append(reinterpret_cast<const char*>(&low), 4);
  };
  word(2);
  word(28 + text.size() + buffer.size());
  word(text.size());
  out += "JSON" + text;
  word(buffer.size());
  return out + std::string("BIN\0", 4) + buffer;
}

/// The file on disk, and its mesh as PLY beside it.
struct Setup {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hyades-gltf-bench-" + std::to_string(getpid()));
  std::unique_ptr<AssetResolver> files;
  size_t bytes = 0;

  Setup() {
    std::filesystem::create_directories(folder);
    const std::string glb = sheet(428);
    bytes = glb.size();
    std::ofstream(folder / "sheet.glb", std::ios::binary) << glb;
    files = make_file_resolver(folder.string());
    const Bytes ply = *(*read_gltf(*files, "sheet.glb"))->made_file("meshes/sheet.ply");
    std::ofstream(folder / "sheet.ply", std::ios::binary)
        .write(ply.chars(), static_cast<std::streamsize>(ply.size()));
  }
  ~Setup() { std::filesystem::remove_all(folder); }
};

Setup& setup() {
  static Setup once;
  return once;
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                          static_cast<int64_t>(setup().bytes));
}

void read_bytes(benchmark::State& state) {
  for (auto _ : state) {
    std::ifstream file(setup().folder / "sheet.glb", std::ios::binary);
    std::string bytes(setup().bytes, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    benchmark::DoNotOptimize(bytes.data());
  }
  count_bytes(state);
}
BENCHMARK(read_bytes)->Unit(benchmark::kMillisecond);

void read_scene_text(benchmark::State& state) {
  for (auto _ : state) {
    const auto source = read_gltf(*setup().files, "sheet.glb");
    benchmark::DoNotOptimize((*source)->sections({}));
  }
  count_bytes(state);
}
BENCHMARK(read_scene_text)->Unit(benchmark::kMillisecond);

void make_mesh_file(benchmark::State& state) {
  const auto source = read_gltf(*setup().files, "sheet.glb");
  for (auto _ : state) benchmark::DoNotOptimize((*source)->made_file("meshes/sheet.ply"));
  count_bytes(state);
}
BENCHMARK(make_mesh_file)->Unit(benchmark::kMillisecond);

void read_mesh_file(benchmark::State& state) {
  setup();
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(*setup().files, "sheet.ply"));
  count_bytes(state);
}
BENCHMARK(read_mesh_file)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
