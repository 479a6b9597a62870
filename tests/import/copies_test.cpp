// Things that a scene places many times look the same by a file of places as by an object each, and
// a million of them take bounded time and memory.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "import/pbrt/read_pbrt.h"
#include "tests/import/gltf_builder.h"
#include "tests/import/rendered_scene.h"

namespace hyades::test {
namespace {

/// Bytes that the process has (VmRSS), or had at most since clear_peak() (VmHWM).
size_t memory_of(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  size_t kib = 0;
  while (status >> word) {
    if (word == key + ":" && status >> kib) return kib << 10;
  }
  return 0;
}

void clear_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

/// Share of pixels whose colours differ by more than a thousandth of the brightest.
double unlike(const ScenePicture& a, const ScenePicture& b) {
  float brightest = 0.0F;
  int differ = 0;
  const int w = a.image.width;
  const int h = a.image.height;
  for (int i = 0; i < w * h; ++i) {
    brightest = std::max(brightest, core::max_component(a.at(i % w, i / w)));
  }
  for (int i = 0; i < w * h; ++i) {
    const core::Rgb d = glm::abs(a.at(i % w, i / w) - b.at(i % w, i / w));
    differ += core::max_component(d) > 1e-3F * brightest ? 1 : 0;
  }
  EXPECT_GT(brightest, 0.1F);
  return static_cast<double>(differ) / (w * h);
}

/// A hundred squares of two colours above each other, 10 x 10, in `nodes` nodes.
std::string quilt(size_t nodes) {
  GltfBuilder b;
  std::vector<nlohmann::json> parts;
  for (int i = 0; i < 2; ++i) {
    parts.push_back(b.square());
    parts.back()["material"] = i;
    const float depth = -0.3F * static_cast<float>(i);
    parts.back()["attributes"]["POSITION"] =
        b.floats({0, 0, depth, 1, 0, depth, 1, 1, depth, 0, 1, depth}, "VEC3");
    const std::vector<float> color = {i == 0 ? 0.8F : 0.1F, 0.3F, i == 0 ? 0.1F : 0.9F, 1.0F};
    b.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", color}}}});
  }
  const int mesh = b.add("meshes", {{"primitives", parts}});
  for (size_t n = 0; n < nodes; ++n) {
    std::vector<float> at;
    std::vector<float> turn;
    std::vector<float> size;
    for (size_t i = n * 100 / nodes; i < (n + 1) * 100 / nodes; ++i) {
      const auto k = static_cast<float>(i);
      at.insert(at.end(), {static_cast<float>(i % 10), static_cast<float>(i / 10), 0});
      const float angle = 0.03F * k;
      turn.insert(turn.end(), {std::sin(angle), 0.2F * std::cos(angle), 0, std::cos(angle)});
      size.insert(size.end(), {0.5F + 0.004F * k, 0.9F, 1});
    }
    b.add("nodes", {{"mesh", mesh},
                    {"translation", {-5, -5, 0}},
                    {"extensions",
                     {{"EXT_mesh_gpu_instancing",
                       {{"attributes",
                         {{"TRANSLATION", b.floats(at, "VEC3")},
                          {"ROTATION", b.floats(turn, "VEC4")},
                          {"SCALE", b.floats(size, "VEC3")}}}}}}}});
    const int times = b.floats({0, 0.5F}, "SCALAR");
    const int ways = b.floats({-5, -5, 0, -3, -5, 0}, "VEC3");
    b.json["animations"][0]["samplers"].push_back({{"input", times}, {"output", ways}});
    b.json["animations"][0]["channels"].push_back(
        {{"sampler", n}, {"target", {{"node", n}, {"path", "translation"}}}});
  }
  return b.glb();
}

TEST(Copies, OfGltfLookTheSameByAFileAsByObjects) {
  const std::string view = "environment: {color: 1}\nframes: {range: 1-3, fps: 4, shutter: 0.8}\n" +
                           Window{.height = 12.0F}.yaml();
  ScenePicture pictures[2];
  for (const size_t nodes : {size_t{1}, size_t{2}}) {
    const auto source = read_glb(quilt(nodes));
    ASSERT_TRUE(source.ok()) << source.error().message;
    pictures[nodes - 1] =
        render_scene(**source, {.yaml = view, .frame = 2}, ".", fmt::format("quilt-{}", nodes));
  }
  EXPECT_NE(pictures[0].job.find("places:"), std::string::npos);
  EXPECT_EQ(pictures[1].job.find("places:"), std::string::npos);
  EXPECT_LE(unlike(pictures[0], pictures[1]), 0.01);
}

/// A hundred balls above disks, of `objects` objects.
std::string balls(int objects) {
  std::string text =
      "Camera \"orthographic\" \"float screenwindow\" [-6 6 -6 6]\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  for (int i = 0; i < objects; ++i) {
    text += fmt::format(
        "ObjectBegin \"o{}\" Material \"diffuse\" \"rgb reflectance\" [.8 .3 .1]\n"
        "Shape \"sphere\" \"float radius\" .3 Material \"diffuse\" \"rgb reflectance\" [.1 .3 .9]\n"
        "Shape \"disk\" \"float radius\" .5 \"float height\" .4 ObjectEnd\n",
        i);
  }
  for (int i = 0; i < 100; ++i) {
    text += fmt::format(
        "AttributeBegin Translate {} {} 5 Rotate {} 1 1 0 Scale 1 {} 1 ObjectInstance \"o{}\" "
        "AttributeEnd\n",
        i % 10 - 4.5, i / 10 - 4.5, 7 * i, 0.5 + 0.005 * i, i * objects / 100);
  }
  return text;
}

TEST(Copies, OfPbrtLookTheSameByAFileAsByObjects) {
  ScenePicture pictures[2];
  for (const int objects : {1, 2}) {
    FilesInMemory files;
    files.files["a.pbrt"] = balls(objects);
    const auto source = core::read_pbrt(files, "a.pbrt");
    ASSERT_TRUE(source.ok()) << source.error().message;
    pictures[objects - 1] = render_scene(**source, {.yaml = "film: {size: [64, 64]}\n"}, ".",
                                         fmt::format("balls-{}", objects));
  }
  EXPECT_NE(pictures[0].job.find("places:"), std::string::npos);
  EXPECT_EQ(pictures[1].job.find("places:"), std::string::npos);
  EXPECT_LE(unlike(pictures[0], pictures[1]), 0.01);
}

constexpr int kMillion = 1'000'000;

/// Reads, builds and renders a little of a scene of a million copies; within `most` bytes above
/// what the process had before.
template <class Read>
void expect_bounded(const char* what, size_t file, size_t most, const Read& read) {
  clear_peak();
  const size_t before = memory_of("VmRSS");
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto source = read();
  ASSERT_TRUE(source.ok()) << source.error().message;
  ASSERT_TRUE((*source)->sections({}).ok());
  const double imported = seconds();
  const size_t import_peak = memory_of("VmHWM") - before;
  const ScenePicture picture =
      render_scene(**source,
                   {.yaml = "environment: {color: 1}\nfilm: {size: [32, 24]}\n"
                            "camera: {look_from: [0, 400, 2500], look_at: [0, 0, 0]}\n",
                    .samples = 1},
                   ".", what);
  const size_t peak = memory_of("VmHWM") - before;
  std::printf("%s, %.0f MB: imported in %.2f s and %.0f MB, rendered after %.2f s and %.0f MB\n",
              what, 1e-6 * static_cast<double>(file), imported,
              1e-6 * static_cast<double>(import_peak), seconds(), 1e-6 * static_cast<double>(peak));
  EXPECT_GT(core::max_component(picture.mean(8, 8, 24, 20)), 0.0F);
  EXPECT_LT(peak, most);
}

TEST(Copies, AMillionOfAGlbTakeBoundedMemory) {
  GltfBuilder b;
  std::vector<float> at;
  std::vector<float> turn;
  std::vector<float> size;
  for (int i = 0; i < kMillion; ++i) {
    at.insert(at.end(), {2.0F * static_cast<float>(i % 1000 - 500), 0,
                         2.0F * static_cast<float>(i / 1000 - 500)});
    turn.insert(turn.end(),
                {0, std::sin(static_cast<float>(i)), 0, std::cos(static_cast<float>(i))});
    size.insert(size.end(), {1, 1, 1});
  }
  b.add("nodes", {{"mesh", b.mesh(b.square())},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing",
                     {{"attributes",
                       {{"TRANSLATION", b.floats(at, "VEC3")},
                        {"ROTATION", b.floats(turn, "VEC4")},
                        {"SCALE", b.floats(size, "VEC3")}}}}}}}});
  at = turn = size = {};
  FilesInMemory files;
  files.files["a.glb"] = b.glb();
  b.buffer = {};
  expect_bounded("million.glb", files.files["a.glb"].size(), size_t{300} << 20,
                 [&] { return core::read_gltf(files, "a.glb"); });
}

TEST(Copies, AMillionOfAPbrtTakeBoundedMemory) {
  std::string text =
      "WorldBegin\nObjectBegin \"tree\" Shape \"sphere\" Shape \"disk\" \"float radius\" .5 "
      "\"float "
      "height\" 1 ObjectEnd\n";
  for (int i = 0; i < kMillion; ++i) {
    text += fmt::format(
        "AttributeBegin Translate {} 0 {} Rotate {} 0 1 0 ObjectInstance \"tree\" AttributeEnd\n",
        2 * (i % 1000 - 500), 2 * (i / 1000 - 500), i % 360);
  }
  FilesInMemory files;
  files.files["a.pbrt"] = std::move(text);
  expect_bounded("million.pbrt", files.files["a.pbrt"].size(), size_t{300} << 20,
                 [&] { return core::read_pbrt(files, "a.pbrt"); });
}

}  // namespace
}  // namespace hyades::test
