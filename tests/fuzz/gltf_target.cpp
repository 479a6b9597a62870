// A glTF scene: a .glb, or the JSON of a .gltf.

#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/scene_target.h"
#include "tests/import/gltf_builder.h"

namespace hyades::fuzz {
namespace {

/// A scene with an animation, a skin, a morph target, a sparse accessor, a camera and a light.
test::GltfBuilder rich_scene() {
  test::GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["JOINTS_0"] = b.accessor<uint8_t>(std::vector<uint8_t>(16, 0), "VEC4");
  square["attributes"]["WEIGHTS_0"] =
      b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int offsets = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3");
  square["targets"] = {{{"POSITION", offsets}}};
  square["material"] = b.add(
      "materials", {{"name", "Skin"},
                    {"alphaMode", "MASK"},
                    {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.2, 1}}}},
                    {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}}}}});
  const int mesh = b.mesh(square);
  b.add("skins", {{"joints", {1}}});
  b.add("nodes", {{"mesh", mesh}, {"skin", 0}, {"name", "body"}});
  b.add("nodes", {{"translation", {0, 1, 0}}, {"children", {2}}});
  b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
  b.add("nodes", {{"camera", 0}});
  const int times = b.floats({0, 1}, "SCALAR");
  const int places = b.floats({0, 0, 0, 1, 2, 3}, "VEC3");
  b.json["animations"] = {
      {{"name", "Walk"},
       {"samplers", {{{"input", times}, {"output", places}, {"interpolation", "LINEAR"}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
  return b;
}

}  // namespace

std::vector<std::string> seeds() {
  test::GltfBuilder plain;
  plain.add("nodes", {{"mesh", plain.mesh(plain.square())}});
  return {rich_scene().glb(), plain.glb(),
          "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"mesh\": 0}], \"meshes\": "
          "[{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], \"accessors\": "
          "[{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}], "
          "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"buffers\": [{\"byteLength\": "
          "36, \"uri\": \"data:application/octet-stream;base64,"
          "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}"};
}

bool try_input(std::string_view input) {
  const std::string name = input.starts_with("glTF") ? "a.glb" : "a.gltf";
  Files files(name, input);
  return try_scene(files, name);
}

}  // namespace hyades::fuzz
