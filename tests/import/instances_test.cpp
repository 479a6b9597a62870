// Where a scene places one thing many times: copies by a file, and what has to be objects.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/read_places.h"
#include "import/mass_copies.h"
#include "tests/import/gltf_builder.h"
#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<core::PlaceMatrix> places_in(const core::SceneSource& source, const std::string& name) {
  const auto bytes = source.made_file(name);
  if (!bytes) throw std::runtime_error(bytes.error().message);
  FilesInMemory files;
  files.files["a.ply"] = std::string(bytes->chars(), bytes->size());
  const auto places = core::read_places(files, "a.ply", 0);
  if (!places) throw std::runtime_error(places.error().message);
  return **places;
}

nlohmann::json instanced(const nlohmann::json& attributes) {
  return {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
}

/// n instances in a row along x, turned by a right angle around y, the i-th of size 1 + i / n.
nlohmann::json row_of(GltfBuilder& b, size_t n, float size = 1.0F) {
  std::vector<float> at;
  std::vector<float> turn;
  std::vector<float> sizes;
  const float half = std::sqrt(0.5F);
  for (size_t i = 0; i < n; ++i) {
    const float s = size * (1.0F + static_cast<float>(i) / static_cast<float>(n));
    at.insert(at.end(), {2.0F * static_cast<float>(i), 0, 0});
    turn.insert(turn.end(), {0, half, 0, half});
    sizes.insert(sizes.end(), {s, s, s});
  }
  return {{"TRANSLATION", b.floats(at, "VEC3")},
          {"ROTATION", b.floats(turn, "VEC4")},
          {"SCALE", b.floats(sizes, "VEC3")}};
}

TEST(GltfInstances, ManyAreOneObjectWithAFileOfPlaces) {
  GltfBuilder b;
  b.add("nodes", {{"mesh", b.mesh(b.square())},
                  {"name", "Tree"},
                  {"translation", {0, 0, 5}},
                  {"extensions", instanced(row_of(b, 100))}});
  core::SceneRequest request;
  request.prefix = "wood";
  const std::string job = job_of(b, request);
  EXPECT_THAT(job, HasSubstr("groups:\n  wood.Tree: {objects: {Tree: {mesh: meshes/Tree.ply, "
                             "material: wood.default}}}\n"));
  EXPECT_THAT(job,
              HasSubstr("wood.Tree:\n    instance: wood.Tree\n    places: places/Tree.ply\n    "
                        "transform: [{matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5"));
  EXPECT_THAT(job, Not(HasSubstr("Tree-2")));
  const auto source = read_glb(b.glb());
  ASSERT_TRUE(source.ok());
  const auto places = places_in(**source, "places/Tree.ply");
  ASSERT_EQ(places.size(), 100U);
  // Scaled, turned, moved; a right angle around y brings x to -z.
  EXPECT_EQ(places[50][3], core::Vec3(100, 0, 0));
  EXPECT_NEAR(places[50][0].z, -1.5F, 1e-6F);
  EXPECT_NEAR(places[50][2].x, 1.5F, 1e-6F);
  EXPECT_FALSE((*source)->made_file("places/Bush.ply").ok());
  EXPECT_FALSE((*source)->made_file("places/").ok());
}

TEST(GltfInstances, FewAreObjects) {
  GltfBuilder b;
  b.add("nodes", {{"mesh", b.mesh(b.square())},
                  {"extensions", instanced(row_of(b, core::kFewestCopies - 1))}});
  const std::string job = job_of(b);
  EXPECT_THAT(job, Not(HasSubstr("places")));
  EXPECT_THAT(job, HasSubstr("object-63:"));
}

TEST(GltfInstances, AllPrimitivesOfAMeshAreInOneGroup) {
  GltfBuilder b;
  b.add("materials", {{"name", "Bark"}});
  b.add("materials", {{"name", "Leaf"}});
  nlohmann::json trunk = b.square();
  trunk["material"] = 0;
  nlohmann::json crown = b.square();
  crown["material"] = 1;
  const int mesh = b.add("meshes", {{"primitives", {trunk, crown}}, {"name", "Oak"}});
  b.add("nodes", {{"mesh", mesh}, {"extensions", instanced(row_of(b, 64))}});
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("Oak.1: {mesh: meshes/Oak-1.ply, material: Bark}"));
  EXPECT_THAT(job, HasSubstr("Oak.2: {mesh: meshes/Oak-2.ply, material: Leaf}"));
  EXPECT_THAT(job, HasSubstr("objects:\n  Oak: {instance: Oak, places: places/Oak.ply}"));
}

TEST(GltfInstances, WhatShinesIsObjects) {
  for (const bool unlit : {false, true}) {
    GltfBuilder b;
    if (unlit) {
      b.add("materials", {{"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
    } else {
      b.add("materials", {{"emissiveFactor", {1, 1, 1}}});
    }
    nlohmann::json square = b.square();
    square["material"] = 0;
    b.add("nodes", {{"mesh", b.mesh(square)}, {"extensions", instanced(row_of(b, 70))}});
    const std::string job = job_of(b);
    EXPECT_THAT(job, Not(HasSubstr("places")));
    EXPECT_THAT(job, HasSubstr("object-70:"));
  }
}

TEST(GltfInstances, ThoseWithoutSizeAreLeftOutAndTinyOnesObjects) {
  GltfBuilder b;
  nlohmann::json row = row_of(b, 70);
  std::vector<float> sizes(210, 1.0F);
  sizes[0] = sizes[1] = sizes[2] = 0.0F;  // hidden
  sizes[4] = 0.0F;                        // flat
  sizes[6] = sizes[7] = sizes[8] = 1e-6F;
  row["SCALE"] = b.floats(sizes, "VEC3");
  row["_ID"] = b.floats(std::vector<float>(70, 1.0F), "SCALAR");
  b.add("nodes", {{"mesh", b.mesh(b.square())}, {"extensions", instanced(row)}});
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("a.glb: nodes[0] has 1 instances of size 0, which are left out"));
  EXPECT_THAT(job, HasSubstr("a.glb: instances of nodes have _ID, which is left out"));
  EXPECT_THAT(job, HasSubstr("object-3:"));
  EXPECT_THAT(job, Not(HasSubstr("object-4:")));
  const auto source = read_glb(b.glb());
  EXPECT_EQ(places_in(**source, "places/copies.ply").size(), 67U);
}

TEST(GltfInstances, ThoseThatGrowOutOfNothingAreObjects) {
  for (const bool from_nothing : {false, true}) {
    GltfBuilder b;
    b.add("nodes", {{"mesh", b.mesh(b.square())}, {"extensions", instanced(row_of(b, 70))}});
    const float first = from_nothing ? 0.0F : 0.5F;
    const int times = b.floats({0, 1}, "SCALAR");
    const int sizes = b.floats({first, first, first, 1, 1, 1}, "VEC3");
    b.add("animations",
          {{"samplers", {{{"input", times}, {"output", sizes}}}},
           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
    EXPECT_THAT(job_of(b), from_nothing ? HasSubstr("object-70:") : HasSubstr("places: "));
  }
}

TEST(GltfInstances, CountsThatNoFileHoldsAreRefused) {
  GltfBuilder b;
  // Numbers that are nowhere are zeros, however many; here they are 2^31 - 1.
  const int none =
      b.add("accessors", {{"componentType", 5126}, {"count", 2147483647}, {"type", "VEC3"}});
  b.add("nodes",
        {{"mesh", b.mesh(b.square())}, {"extensions", instanced({{"TRANSLATION", none}})}});
  EXPECT_THAT(job_of(b), HasSubstr("instances; at most 50000000 are possible"));
  b.json["accessors"].back()["count"] = 40'000'000;
  EXPECT_THAT(job_of(b), HasSubstr("accessors[3]"));
}

/// 1,100 nodes of one mesh below one that is moved up; the first one moves by itself.
GltfBuilder many_nodes(const nlohmann::json& material = nlohmann::json::object()) {
  GltfBuilder b;
  b.add("materials", material);
  nlohmann::json square = b.square();
  square["material"] = 0;
  const int mesh = b.mesh(square);
  b.json["meshes"][0]["name"] = "Stone";
  nlohmann::json children;
  b.add("nodes", {{"translation", {0, 7, 0}}});
  for (int i = 1; i <= 1100; ++i) {
    b.add("nodes", {{"mesh", mesh}, {"name", "S" + std::to_string(i)}, {"translation", {i, 0, 0}}});
    children.push_back(i);
  }
  b.json["nodes"][0]["children"] = children;
  const int times = b.floats({0, 1}, "SCALAR");
  const int ways = b.floats({0, 0, 0, 1, 1, 1}, "VEC3");
  b.add("animations",
        {{"name", "Roll it"},
         {"samplers", {{{"input", times}, {"output", ways}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
  return b;
}

TEST(GltfInstances, VeryManyNodesOfAMeshAreOneObjectToo) {
  const GltfBuilder b = many_nodes();
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("Stone: {instance: Stone, places: places/Roll_it/Stone.ply}"));
  EXPECT_THAT(job, HasSubstr("S1:\n"));
  EXPECT_THAT(job, Not(HasSubstr("S2:")));
  const auto source = read_glb(b.glb());
  ASSERT_TRUE(source.ok());
  const auto moving = places_in(**source, "places/Roll_it/Stone.ply");
  ASSERT_EQ(moving.size(), 1099U);
  EXPECT_EQ(moving[0][3], core::Vec3(2, 7, 0));
  EXPECT_EQ(places_in(**source, "places/Stone.ply").size(), 1100U);
  EXPECT_FALSE((*source)->made_file("places/Walk/Stone.ply").ok());
  const auto sections = (*source)->sections({});
  ASSERT_TRUE(sections.ok());
  EXPECT_NEAR(sections->bounds.upper.x, 1101.0F, 1e-3F);
  EXPECT_NEAR(sections->bounds.upper.y, 8.0F, 1e-5F);
  const core::SceneRequest still = [] {
    core::SceneRequest request;
    request.animation = "none";
    return request;
  }();
  EXPECT_THAT(job_of(b, still), HasSubstr("places: places/Stone.ply"));
  EXPECT_THAT(job_of(b, still), Not(HasSubstr("S1:")));
}

TEST(GltfInstances, NodesThatShineOrAreFewerAreObjects) {
  EXPECT_THAT(job_of(many_nodes({{"emissiveFactor", {1, 1, 1}}})), HasSubstr("S1100:"));
  GltfBuilder fewer = many_nodes();
  for (int i = 1; i <= 100; ++i) fewer.json["nodes"][i].erase("mesh");
  EXPECT_THAT(job_of(fewer), HasSubstr("S1100:"));
}

std::string row_of_instances(const std::string& object, int n, int first = 0) {
  std::string text;
  for (int i = first; i < first + n; ++i) {
    text += "AttributeBegin Translate " + std::to_string(2 * i) + " 0 0 Scale 1 1 2 ";
    text += "ObjectInstance \"" + object + "\" AttributeEnd\n";
  }
  return text;
}

TEST(PbrtInstances, ManyAreOneObjectWithAFileOfPlaces) {
  const PbrtJob job = pbrt_job(pbrt_world(
      "ObjectBegin \"tree\" Shape \"sphere\" Shape \"disk\" \"float height\" 2 ObjectEnd\n" +
      row_of_instances("tree", 100)));
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("groups:\n  tree:\n    objects:\n      sphere:"));
  EXPECT_THAT(job.text, HasSubstr("disk:"));
  EXPECT_THAT(job.text, HasSubstr("objects:\n  instances-tree: {instance: tree, places: "
                                  "places/object-0.ply}\n"));
  EXPECT_THAT(job.text, Not(HasSubstr("instance-tree")));
  const auto places = places_in(*job.source, "places/object-0.ply");
  ASSERT_EQ(places.size(), 100U);
  for (const size_t i : {size_t{5}, size_t{80}}) {
    // The world is mirrored, and with it every place.
    EXPECT_EQ(places[i][3], core::Vec3(-2.0F * static_cast<float>(i), 0, 0));
    EXPECT_EQ(places[i][0], core::Vec3(-1, 0, 0));
    EXPECT_EQ(places[i][2], core::Vec3(0, 0, 2));
  }
  EXPECT_FALSE(job.source->made_file("places/object-1.ply").ok());
  EXPECT_FALSE(job.source->made_file("places/object-.ply").ok());
}

TEST(PbrtInstances, FewAreObjects) {
  const PbrtJob job = pbrt_job(pbrt_world("ObjectBegin \"tree\" Shape \"sphere\" ObjectEnd\n" +
                                          row_of_instances("tree", 63)));
  EXPECT_THAT(job.text, Not(HasSubstr("places")));
  EXPECT_THAT(job.text, HasSubstr("instance-tree-63:"));
  EXPECT_FALSE(job.source->made_file("places/object-0.ply").ok());
}

TEST(PbrtInstances, ThoseThatMoveAreObjects) {
  const PbrtJob job = pbrt_job(
      pbrt_world("ObjectBegin \"tree\" Shape \"sphere\" ObjectEnd\n"
                 "AttributeBegin ActiveTransform EndTime Translate 0 1 0 ActiveTransform All "
                 "ObjectInstance \"tree\" AttributeEnd\n" +
                 row_of_instances("tree", 64)));
  EXPECT_THAT(job.text, HasSubstr("instance-tree:\n    instance: tree\n    transform:"));
  EXPECT_THAT(job.text, Not(HasSubstr("instance-tree-2:")));
  EXPECT_EQ(places_in(*job.source, "places/object-0.ply").size(), 64U);
}

TEST(PbrtInstances, TinyOnesAndThoseFilledWithAMediumThatVariesAreObjects) {
  const PbrtJob tiny = pbrt_job(pbrt_world("ObjectBegin \"tree\" Shape \"sphere\" ObjectEnd\n" +
                                           row_of_instances("tree", 70) +
                                           "Scale 1e-6 1e-6 1e-6 ObjectInstance \"tree\""));
  EXPECT_THAT(tiny.text, HasSubstr("instance-tree: {instance: tree, transform:"));
  EXPECT_EQ(places_in(*tiny.source, "places/object-0.ply").size(), 70U);
  const PbrtJob cloud = pbrt_job(
      pbrt_world("MakeNamedMedium \"fog\" \"string type\" \"cloud\"\nObjectBegin \"puff\" Material "
                 "\"interface\" MediumInterface \"fog\" \"\" Shape \"sphere\" ObjectEnd "
                 "MediumInterface \"\"\n" +
                 row_of_instances("puff", 70)));
  EXPECT_THAT(cloud.text, HasSubstr("instance-puff-70:"));
  EXPECT_THAT(cloud.text, Not(HasSubstr("places")));
}

}  // namespace
}  // namespace hyades::test
