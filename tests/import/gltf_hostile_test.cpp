// Broken and hostile glTF files: an error that names the place, within bounded time and memory.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/gltf_builder.h"
#include "tests/support/made_files.h"
#include "tests/support/random.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;

GltfBuilder one_square() {
  GltfBuilder b;
  b.add("nodes", {{"mesh", b.mesh(b.square())}});
  return b;
}

/// What is wrong with the meshes and places that objects name; empty: nothing.
std::string trouble_of(const core::SceneSource& source, const core::YamlNode& objects) {
  for (const std::string& name : made_files_of(objects)) {
    const auto made = source.made_file(name);
    if (!made) return made.error().message;
  }
  return {};
}

/// What is wrong with a scene and all of its meshes; empty: nothing.
std::string trouble(const core::Result<std::shared_ptr<const core::SceneSource>>& source) {
  if (!source) return source.error().message;
  core::SceneRequest request;
  request.loop = true;
  const auto sections = (*source)->sections(request);
  if (!sections) return sections.error().message;
  if (const core::YamlEntry* groups = sections->sections->find("groups")) {
    for (const core::YamlEntry& group : groups->value->map) {
      const std::string wrong = trouble_of(**source, *group.value->find("objects")->value);
      if (!wrong.empty()) return wrong;
    }
  }
  const core::YamlEntry* objects = sections->sections->find("objects");
  return objects == nullptr ? "" : trouble_of(**source, *objects->value);
}

std::string trouble(const std::string& glb) { return trouble(read_glb(glb)); }
std::string trouble(const GltfBuilder& b) { return trouble(b.glb()); }

TEST(GltfHostile, TheSquareIsFine) { EXPECT_EQ(trouble(one_square()), ""); }

TEST(GltfHostile, TruncatedFilesAreRefusedWhereverTheyEnd) {
  const std::string whole = one_square().glb();
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(trouble(whole.substr(0, size)), HasSubstr("a.glb: ")) << size;
  }
}

TEST(GltfHostile, JsonThatIsNoGltf) {
  EXPECT_EQ(trouble("[]"), "a.glb: it is JSON, but no glTF");
  EXPECT_EQ(trouble("{}"), "a.glb: asset.version is '', expected 2.0");
  EXPECT_THAT(trouble("{\"asset\": 1e999}"), HasSubstr("a.glb: it is not valid JSON"));
  EXPECT_THAT(trouble(std::string(1 << 20, '[')),
              HasSubstr("its JSON is more than 64 levels deep"));
  EXPECT_THAT(trouble("{\"asset\": \"\xFF\"}"), HasSubstr("a.glb: it is not valid JSON"));
}

TEST(GltfHostile, ExtensionsThatAreRequired) {
  GltfBuilder b = one_square();
  b.json["extensionsRequired"] = {"EXT_time_travel"};
  b.json["extensionsUsed"] = {"EXT_time_travel"};
  EXPECT_EQ(trouble(b), "a.glb: it requires the extension EXT_time_travel, which is not supported");
  b.json.erase("extensionsRequired");
  EXPECT_THAT(job_of(b), HasSubstr("a.glb: extension EXT_time_travel is not supported and left "
                                   "out"));
}

TEST(GltfHostile, NodesThatAreNoTree) {
  GltfBuilder b = one_square();
  b.add("nodes", {{"children", {2}}});
  b.add("nodes", {{"children", {1}}});
  EXPECT_THAT(trouble(b), HasSubstr("is its own descendant"));
  b.json["nodes"][2]["children"] = {0};
  b.json["nodes"][1]["children"] = {0, 2};
  EXPECT_EQ(trouble(b), "a.glb: nodes[0] is a child of both nodes[1] and nodes[2]");
  b.json["nodes"][1]["children"] = {7};
  EXPECT_EQ(trouble(b), "a.glb: nodes[1].children[0] is 7, expected a whole number from 0 to 2");
}

TEST(GltfHostile, ChainsOfNodesWithoutEnd) {
  GltfBuilder b = one_square();
  for (int i = 0; i < 5000; ++i) b.add("nodes", {{"children", {i}}});
  EXPECT_THAT(trouble(b), HasSubstr("lies more than 1024 nodes deep"));
}

TEST(GltfHostile, ManyNodesOfOneName) {
  GltfBuilder b = one_square();
  for (int i = 1; i < 20; ++i) b.mesh(b.square());
  for (int i = 0; i < 20'000; ++i) b.add("nodes", {{"mesh", i % 20}, {"name", "Box"}});
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("Box-20000:"));
}

TEST(GltfHostile, CountsAreCheckedBeforeMemoryIsTaken) {
  GltfBuilder b = one_square();
  b.json["accessors"][0]["count"] = 2'000'000'000;
  EXPECT_EQ(trouble(b),
            "a.glb: accessors[0] has 2000000000 elements of 12 bytes, which do not lie within the "
            "48 bytes of its view");
  b.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(trouble(b),
            "a.glb: accessors[0] has 2000000000 elements, more than the file has bytes");
  b.json["accessors"][0]["count"] = 1e30;
  EXPECT_THAT(trouble(b), HasSubstr("accessors[0].count is 1e+30, expected a whole number"));
  b.json["accessors"][0]["count"] = -4;
  EXPECT_THAT(trouble(b), HasSubstr("accessors[0].count is -4"));
}

/// Each primitive is a mesh of its own.
TEST(GltfHostile, OneListOfManyPrimitives) {
  for (const bool indexed : {false, true}) {
    GltfBuilder b;
    nlohmann::json large;
    if (indexed) {
      large = b.square();
      large["indices"] = b.accessor<uint8_t>(std::vector<uint8_t>(30'000, 1), "SCALAR");
    } else {
      large["attributes"]["POSITION"] = b.floats(std::vector<float>(30'000, 1.0F), "VEC3");
    }
    const int mesh = b.mesh(large);
    nlohmann::json& primitives = b.json["meshes"][static_cast<size_t>(mesh)]["primitives"];
    for (int i = 1; i < 150; ++i) primitives.push_back(large);
    b.add("nodes", {{"mesh", mesh}});
    EXPECT_THAT(job_of(b), HasSubstr("-150.ply"));
    for (int i = 150; i < 1000; ++i) primitives.push_back(large);
    EXPECT_THAT(job_of(b), HasSubstr("a.glb: its meshes have 10000000 vertices or triangles "
                                     "together, which is too much for "));
  }
}

/// So is what each node shapes.
TEST(GltfHostile, OneMeshOfManySkins) {
  GltfBuilder b;
  nlohmann::json large;
  large["attributes"]["POSITION"] = b.floats(std::vector<float>(30'000, 1.0F), "VEC3");
  const int mesh = b.mesh(large);
  b.add("nodes", {{"name", "joint"}});
  b.add("skins", {{"joints", {0}}});
  for (int i = 0; i < 1000; ++i) b.add("nodes", {{"mesh", mesh}});
  EXPECT_THAT(job_of(b), HasSubstr("objects:"));
  for (int i = 1; i <= 1000; ++i) b.json["nodes"][static_cast<size_t>(i)]["skin"] = 0;
  EXPECT_THAT(job_of(b), HasSubstr("its meshes have 10000000 vertices or triangles together"));
}

TEST(GltfHostile, AFileThatIsNamedManyTimesCountsOnce) {
  GltfBuilder b = one_square();
  b.json["accessors"][0].erase("bufferView");
  b.json["accessors"][0]["count"] = 5000;
  nlohmann::json json = b.json;
  json["buffers"] = nlohmann::json::array();
  for (int i = 0; i < 16; ++i) json["buffers"].push_back({{"byteLength", 1000}, {"uri", "x.bin"}});
  FilesInMemory files;
  files.files["a.gltf"] = json.dump();
  files.files["x.bin"] = std::string(1000, '\0');
  EXPECT_THAT(trouble(core::read_gltf(files, "a.gltf")),
              HasSubstr("accessors[0] has 5000 elements, more than the file has bytes"));
}

TEST(GltfHostile, ViewsBeyondTheirBuffer) {
  GltfBuilder b = one_square();
  b.json["bufferViews"][1]["byteOffset"] = int64_t{1} << 40;
  EXPECT_THAT(trouble(b), HasSubstr("bufferViews[1] has bytes 1099511627776 to"));
  b.json["bufferViews"][1]["byteOffset"] = 0;
  b.json["bufferViews"][1]["byteStride"] = -4;
  EXPECT_THAT(trouble(b), HasSubstr("bufferViews[1].byteStride is -4"));
  b.json["bufferViews"][1]["byteStride"] = 4;
  EXPECT_THAT(trouble(b), HasSubstr("accessors[1] has elements of 8 bytes, but its view has one "
                                    "every 4"));
}

TEST(GltfHostile, IndicesBeyondTheVertices) {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["indices"] = b.accessor<uint16_t>({0, 1, 4}, "SCALAR");
  b.add("nodes", {{"mesh", b.mesh(square)}});
  EXPECT_EQ(trouble(b), "a.glb: meshes[0].primitives[0] has index 4, but there are 4 vertices");
}

TEST(GltfHostile, NumbersThatAreNone) {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["POSITION"] = b.floats({0, 0, 0, 1, NAN, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  b.add("nodes", {{"mesh", b.mesh(square)}});
  EXPECT_THAT(trouble(b), HasSubstr("has numbers that are not finite"));
}

TEST(GltfHostile, PathsThatLeaveTheFolder) {
  for (const char* path : {"../secret.bin", "a/../../secret.bin", "/etc/passwd", "%2e%2e/secret",
                           "file:///etc/passwd", "..\\secret", "https://example.org/a.bin"}) {
    GltfBuilder b = one_square();
    nlohmann::json json = b.json;
    json["buffers"] = {{{"byteLength", 1000}, {"uri", path}}};
    EXPECT_THAT(trouble(json.dump()), HasSubstr("expected a file in the scene's folder")) << path;
    b.add("images", {{"uri", path}});
    EXPECT_THAT(trouble(b), HasSubstr("a.glb: images[0]: ")) << path;
  }
}

TEST(GltfHostile, SparseElementsBeyondTheirAccessor) {
  GltfBuilder b = one_square();
  const uint16_t index = 9;
  const float values[3] = {0, 0, 0};
  const int indices = b.view(&index, 2);
  const int at = b.view(values, 12);
  b.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
      {"values", {{"bufferView", at}}}};
  EXPECT_EQ(trouble(b), "a.glb: accessors[0].sparse replaces element 9, but there are 4");
  b.json["accessors"][0]["sparse"]["count"] = 1'000'000'000;
  EXPECT_THAT(trouble(b), HasSubstr("accessors[0].sparse.count is 1000000000"));
}

/// A file with a skin, targets, instances, an animation, materials and extensions.
std::string rich_file() {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["JOINTS_0"] = b.accessor<uint8_t>(std::vector<uint8_t>(16, 0), "VEC4");
  square["attributes"]["WEIGHTS_0"] =
      b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  square["targets"] = {{{"POSITION", b.floats(std::vector<float>(12, 0.5F), "VEC3")}}};
  square["material"] = 0;
  b.add("materials",
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 0}}}}},
         {"alphaMode", "MASK"},
         {"extensions",
          {{"KHR_materials_volume",
            {{"thicknessFactor", 1},
             {"attenuationDistance", 2},
             {"attenuationColor", {0.5, 0.6, 0.7}}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  b.add(
      "materials",
      {{"doubleSided", true},
       {"extensions",
        {{"KHR_materials_pbrSpecularGlossiness",
          {{"specularFactor", {0.5, 0.6, 0.7}}, {"specularGlossinessTexture", {{"index", 0}}}}}}}});
  b.add("textures", {{"source", 0}});
  b.add("images", {{"uri", "data:image/png;base64,iVBORw0KGgo="}});
  b.add("nodes", {{"mesh", b.mesh(square)}, {"skin", 0}, {"weights", {0.5}}});
  b.add("nodes", {{"translation", {0, 1, 0}}, {"camera", 0}});
  b.add("skins", {{"joints", {1}}});
  b.add("cameras", {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 2}}}});
  const int times = b.floats({0, 1}, "SCALAR");
  const int moves = b.floats(std::vector<float>(18, 0.25F), "VEC3");
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", moves}, {"interpolation", "CUBICSPLINE"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
  nlohmann::json plain = b.square();
  plain["material"] = 1;
  std::vector<float> at;
  std::vector<float> turn;
  for (int i = 0; i < 70; ++i) {
    at.insert(at.end(), {static_cast<float>(i), 0, 1});
    turn.insert(turn.end(), {0, 0.6F, 0, 0.8F});
  }
  b.add("nodes",
        {{"mesh", b.mesh(plain)},
         {"extensions",
          {{"EXT_mesh_gpu_instancing",
            {{"attributes",
              {{"TRANSLATION", b.floats(at, "VEC3")}, {"ROTATION", b.floats(turn, "VEC4")}}}}}}}});
  return b.glb();
}

TEST(GltfHostile, MutatedFilesGiveAnErrorOrAScene) {
  const std::string whole = rich_file();
  ASSERT_EQ(trouble(whole), "");
  Random random(7);
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string file = whole;
    const int changes = 1 + static_cast<int>(random.uniform() * 4);
    for (int i = 0; i < changes; ++i) {
      const auto at = static_cast<size_t>(random.uniform() * static_cast<float>(file.size()));
      const float what = random.uniform();
      if (what < 0.4F) {
        file[at] = static_cast<char>('0' + static_cast<int>(random.uniform() * 10));
      } else if (what < 0.7F) {
        file[at] = static_cast<char>(random.uniform() * 256);
      } else {
        const size_t from = static_cast<size_t>(random.uniform() * static_cast<float>(file.size()));
        const size_t n = std::min<size_t>(12, file.size() - std::max(at, from));
        file.replace(at, n, file.substr(from, n));
      }
    }
    if (!trouble(file).empty()) ++refused;
  }
  // Most changes hit something that matters; many are harmless.
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 3900);
}

}  // namespace
}  // namespace hyades::test
