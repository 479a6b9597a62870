#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/geometry/read_hair.h"
#include "core/job/parse.h"
#include "core/scene/appearance.h"
#include "core/scene/build_scene.h"
#include "core/scene/light_makers.h"
#include "core/scene/material_makers.h"
#include "core/scene/shape_makers.h"
#include "core/scene/texture_makers.h"
#include "core/scene/volume_makers.h"
#include "tests/core/job/test_assets.h"

/// The names that a job may give are listed by the job room; the scene room makes things of them.
namespace hyades::core {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

constexpr const char* kTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A Radiance picture of one grey pixel.
std::string one_pixel() {
  return std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n") + "\x80\x80\x80\x81";
}

/// A strand from the origin upwards.
std::string two_points() {
  const Bytes file = hair_bytes({{Vec3(0.0F), Vec3(0.0F, 1.0F, 0.0F)}, {0.1F, 0.1F}, {}, {2}});
  return {file.chars(), file.size()};
}

Status builds(const std::string& text) {
  MemoryAssets assets;
  assets.add("triangle.ply", kTriangle);
  assets.add("pixel.hdr", one_pixel());
  assets.add("fur.hair", two_points());
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\n" + text, "kinds.yaml", assets, diagnostics);
  if (!diagnostics.empty()) return Error{diagnostics.to_string()};
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  if (!scene) return scene.error();
  return {};
}

void expect_builds(const std::string& text) {
  const Status built = builds(text);
  EXPECT_TRUE(built) << text << "\n" << built.error().message;
}

TEST(Kinds, EveryNameOfAJobHasAMaker) {
  std::vector<std::string> shapes(kShapeNames.begin(), kShapeNames.end());
  shapes.insert(shapes.end(), {"mesh", "curves"});
  EXPECT_THAT(made_shapes(), UnorderedElementsAreArray(shapes));
  EXPECT_THAT(made_curve_bases(), UnorderedElementsAreArray(kCurveBasisNames));
  EXPECT_THAT(made_color_spaces(), UnorderedElementsAreArray(textures::kColorSpaces));
  EXPECT_THAT(made_wraps(), UnorderedElementsAreArray(textures::kWraps));
  EXPECT_THAT(made_texture_filters(), UnorderedElementsAreArray(textures::kFilters));
  EXPECT_THAT(made_mappings(), UnorderedElementsAreArray(textures::kMappings));
  EXPECT_THAT(made_mapping_spaces(), UnorderedElementsAreArray(textures::kMappingSpaces));
  EXPECT_THAT(made_channels(), UnorderedElementsAreArray(textures::kChannels));
  EXPECT_THAT(made_cell_metrics(), UnorderedElementsAreArray(textures::kMetrics));
  EXPECT_THAT(made_cell_features(), UnorderedElementsAreArray(textures::kFeatures));
  EXPECT_THAT(made_gradient_shapes(), UnorderedElementsAreArray(textures::kGradientShapes));
  EXPECT_THAT(made_remap_ends(), UnorderedElementsAreArray(textures::kRemapEnds));
  EXPECT_THAT(made_ramp_shapes(), UnorderedElementsAreArray(textures::kRampShapes));
  EXPECT_THAT(made_mesh_normals(), UnorderedElementsAreArray(kMeshNormalsNames));
  EXPECT_THAT(made_vdb_places(), UnorderedElementsAreArray(kVdbPlaceNames));
}

/// What docs/job.md lists as the range of `key` in the table below the heading of `section`.
std::vector<std::string> documented(const std::string& section, const std::string& key) {
  std::ifstream page("docs/job.md");
  bool here = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) here = line.ends_with(": `" + section + "`");
    if (!here || !line.starts_with("| " + key + " |")) continue;
    std::stringstream row(line);
    std::string cell;
    for (int i = 0; i < 6; ++i) std::getline(row, cell, '|');  // key, type, unit, default, range
    std::vector<std::string> names;
    std::stringstream list(cell);
    for (std::string name; std::getline(list, name, ',');) {
      const size_t begin = name.find_first_not_of(' ');
      names.push_back(name.substr(begin, name.find_last_not_of(' ') - begin + 1));
    }
    return names;
  }
  return {};
}

TEST(Kinds, TheReferenceListsTheSameNames) {
  EXPECT_THAT(KindsOf<TextureKind>::names(),
              UnorderedElementsAreArray(documented("textures", "type")));
  EXPECT_THAT(KindsOf<MaterialKind>::names(),
              UnorderedElementsAreArray(documented("materials", "type")));
  EXPECT_THAT(KindsOf<LightKind>::names(), UnorderedElementsAreArray(documented("lights", "type")));
  std::vector<std::string> shapes = documented("objects", "shape");
  shapes.insert(shapes.end(), {"mesh", "curves"});
  EXPECT_THAT(made_shapes(), UnorderedElementsAreArray(shapes));
  EXPECT_THAT(made_color_spaces(),
              UnorderedElementsAreArray(documented("textures.image", "color_space")));
  EXPECT_THAT(made_wraps(), UnorderedElementsAreArray(documented("textures.image", "wrap")));
  EXPECT_THAT(made_texture_filters(),
              UnorderedElementsAreArray(documented("textures.image", "filter")));
  EXPECT_THAT(made_mappings(), UnorderedElementsAreArray(documented("textures.mapping", "type")));
  EXPECT_THAT(made_mapping_spaces(),
              UnorderedElementsAreArray(documented("textures.mapping", "space")));
  EXPECT_THAT(made_channels(), UnorderedElementsAreArray(documented("textures.image", "channel")));
  EXPECT_THAT(made_cell_metrics(),
              UnorderedElementsAreArray(documented("textures.cellular", "metric")));
  EXPECT_THAT(made_cell_features(),
              UnorderedElementsAreArray(documented("textures.cellular", "feature")));
  EXPECT_THAT(made_gradient_shapes(),
              UnorderedElementsAreArray(documented("textures.gradient", "shape")));
  EXPECT_THAT(made_remap_ends(), UnorderedElementsAreArray(documented("textures.remap", "ends")));
  EXPECT_THAT(made_ramp_shapes(),
              UnorderedElementsAreArray(documented("textures.ramp", "between")));
  EXPECT_THAT(made_mesh_normals(),
              UnorderedElementsAreArray(documented("objects.mesh", "normals")));
  EXPECT_THAT(made_curve_bases(), UnorderedElementsAreArray(documented("objects.curves", "basis")));
}

TEST(Kinds, ASceneIsBuiltOfEach) {
  for (const std::string& type : KindsOf<TextureKind>::names()) {
    std::string more;
    if (type == "constant") more = ", value: 0.5";
    if (type == "image") more = ", file: pixel.hdr";
    if (type == "ramp") more = ", input: 0.5, stops: {0: 0.1, 1: 0.9}";
    if (type == "channel") more = ", input: 0.5, channel: red";
    if (type == "power") more = ", input: 0.5, exponent: 2";
    for (const char* of_one : {"scale", "invert", "remap", "threshold", "hue-saturation"}) {
      if (type == of_one) more = ", input: 0.5";
    }
    for (const char* of_two : {"add", "divide", "min", "max", "mix"}) {
      if (type == of_two) more = ", a: 0.5, b: 0.2";
    }
    expect_builds("textures: {x: {type: '" + type + "'" + more +
                  "}}\nmaterials: {m: {type: lambert, color: x}}\n"
                  "objects: {o: {shape: sphere, material: m}}\n");
  }
  for (const std::string& type : KindsOf<MaterialKind>::names()) {
    std::string more;
    if (type == "mix") more = ", first: a, second: a";
    if (type == "coat") more = ", base: a";
    if (type == "two-sided") more = ", front: a, back: a";
    expect_builds("materials: {a: {type: lambert}, m: {type: '" + type + "'" + more +
                  "}}\nobjects: {o: {" + (type == "hair" ? "curves: fur.hair" : "shape: sphere") +
                  ", material: m}}\n");
  }
  for (const std::string& type : KindsOf<LightKind>::names()) {
    const std::string more = type == "projector" ? ", image: pixel.hdr" : "";
    expect_builds("lights: {l: {type: " + type + more + "}}\n");
  }
  for (const std::string& shape : kShapeNames) {
    expect_builds("objects: {o: {shape: " + shape + "}}\n");
  }
  expect_builds("objects: {o: {mesh: triangle.ply}}\n");
  expect_builds("objects: {o: {curves: fur.hair}}\n");
  for (const std::string& name : textures::kWraps) {
    expect_builds("textures: {x: {type: image, file: pixel.hdr, wrap: " + name +
                  "}}\nmaterials: {m: {type: lambert, color: x}}\n"
                  "objects: {o: {shape: sphere, material: m}}\n");
  }
}

/// The grey of a picture of a black and a white pixel, at u = 1.25 when it repeats, clamps, ...
float beyond_the_edge(const std::string& wrap) {
  MemoryAssets assets;
  assets.add("two.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                            std::string("\0\0\0\0", 4) + "\x80\x80\x80\x81");
  Job job;
  textures::Image image;
  image.file = "two.hdr";
  image.filter = "nearest";
  image.wrap = wrap;
  job.textures.push_back({.name = "x", .where = {}, .kind = image});
  SceneCache cache(assets);
  Appearance looks(job, job.time_of(1), cache);
  const auto made = looks.texture("x");
  if (!made) return -1.0F;
  TexturePoint at;
  at.uv = Vec2(-0.25F, 0.5F);
  const float left = (*made)->color(at).x;
  at.uv = Vec2(1.25F, 0.5F);
  return 10.0F * left + (*made)->color(at).x;
}

TEST(Kinds, WrapsDoWhatTheirNamesSay) {
  EXPECT_NEAR(beyond_the_edge("repeat"), 10.0F, 0.1F) << "white, black";
  EXPECT_NEAR(beyond_the_edge("clamp"), 1.0F, 0.1F) << "black, white";
  EXPECT_NEAR(beyond_the_edge("mirror"), 1.0F, 0.1F) << "black, white";
  EXPECT_NEAR(beyond_the_edge("black"), 0.0F, 0.1F);
}

/// A job that no parser has seen, with one textured ball.
Job textured_job() {
  Job job;
  textures::Image image;
  image.file = "pixel.hdr";
  job.textures.push_back({.name = "x", .where = {}, .kind = image});
  MaterialDesc material;
  material.name = "m";
  material.kind = LambertDesc{.color = {{}, "x"}, .roughness = {}};
  job.materials.push_back(material);
  ObjectDesc object;
  object.name = "o";
  object.shape = "sphere";
  object.material = "m";
  job.objects.push_back(object);
  return job;
}

std::string refusal(const Job& job) {
  MemoryAssets assets;
  assets.add("pixel.hdr", one_pixel());
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  return scene ? "" : scene.error().message;
}

TEST(Kinds, AnUnknownNameIsAnErrorThatListsTheOthers) {
  EXPECT_EQ(refusal(textured_job()), "");
  Job job = textured_job();
  std::get<textures::Image>(job.textures[0].kind).wrap = "wound";
  EXPECT_THAT(refusal(job), HasSubstr("there is no wrap 'wound', expected one of repeat, clamp"));
  job = textured_job();
  std::get<textures::Image>(job.textures[0].kind).color_space = "lab";
  EXPECT_THAT(refusal(job), HasSubstr("there is no color_space 'lab', expected one of auto"));
  job = textured_job();
  job.objects[0].shape = "torus";
  EXPECT_THAT(refusal(job), HasSubstr("object 'o': there is no shape 'torus'"));
}

}  // namespace
}  // namespace hyades::core
