#pragma once

#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/geometry/read_mesh.h"
#include "core/job/yaml_writer.h"
#include "import/gltf/read_gltf.h"

namespace hyades::test {

/// Files in memory.
class FilesInMemory : public core::AssetResolver {
 public:
  std::map<std::string, std::string> files;

  core::Result<core::Bytes> open(const std::string& reference, const std::string& from) override {
    const auto at = files.find(core::resolve_reference(reference, from));
    if (at == files.end()) return core::Error{"'" + reference + "' is not there"};
    auto text = std::make_shared<std::string>(at->second);
    return core::Bytes(text, std::as_bytes(std::span(*text)));
  }
};

/// A glTF file in the making: JSON to write to, and a buffer that grows.
class GltfBuilder {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string buffer;

  /// Appends bytes as a view; its number.
  int view(const void* data, size_t size, int stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    nlohmann::json out = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}};
    if (stride != 0) out["byteStride"] = stride;
    buffer.append(static_cast<const char*>(data), size);
    return add("bufferViews", out);
  }

  /// Appends an accessor of numbers of type T; its number.
  template <class T>
  int accessor(const std::vector<T>& numbers, const std::string& type, bool normalized = false) {
    const int at = view(numbers.data(), numbers.size() * sizeof(T));
    nlohmann::json out = {{"bufferView", at},
                          {"componentType", component<T>()},
                          {"count", numbers.size() / width(type)},
                          {"type", type}};
    if (normalized) out["normalized"] = true;
    return add("accessors", out);
  }

  int floats(const std::vector<float>& numbers, const std::string& type) {
    return accessor(numbers, type);
  }

  /// Appends to a list at the top; its number.
  int add(const std::string& list, const nlohmann::json& item) {
    json[list].push_back(item);
    return static_cast<int>(json[list].size()) - 1;
  }

  /// A mesh of one primitive; its number.
  int mesh(const nlohmann::json& primitive) { return add("meshes", {{"primitives", {primitive}}}); }

  /// A unit square in z = 0, seen from +z, v downwards: attributes and indices of a primitive.
  nlohmann::json square() {
    const int positions = floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const int uvs = floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
    const int indices = accessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    return {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"indices", indices}};
  }

  /// A .glb of all.
  std::string glb() const {
    nlohmann::json whole = json;
    std::string binary = buffer;
    binary.resize((binary.size() + 3) / 4 * 4);
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    const auto word = [&](size_t number) {
      const auto low = static_cast<uint32_t>(number);
      out.append(reinterpret_cast<const char*>(&low), 4);
    };
    word(2);
    word(28 + text.size() + binary.size());
    word(text.size());
    out += "JSON" + text;
    word(binary.size());
    out += std::string("BIN\0", 4) + binary;
    return out;
  }

 private:
  template <class T>
  static int component() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
  }

  static size_t width(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  }
};

/// Reads a .glb from memory.
inline core::Result<std::shared_ptr<const core::SceneSource>> read_glb(const std::string& glb) {
  FilesInMemory files;
  files.files["a.glb"] = glb;
  return core::read_gltf(files, "a.glb");
}

/// The scene of a builder as a job's text; the error where there is one.
inline std::string job_of(const GltfBuilder& builder, const core::SceneRequest& request = {}) {
  const auto source = read_glb(builder.glb());
  if (!source) return source.error().message;
  const auto sections = (*source)->sections(request);
  if (!sections) return sections.error().message;
  std::string text = core::write_yaml(*sections->sections);
  for (const std::string& note : sections->notes) text += "# " + note + "\n";
  return text;
}

/// A mesh file of a builder's scene.
inline std::shared_ptr<const core::TriangleMesh> mesh_of(const GltfBuilder& builder,
                                                         const std::string& name) {
  const auto source = read_glb(builder.glb());
  if (!source) throw std::runtime_error(source.error().message);
  const auto bytes = (*source)->made_file(name);
  if (!bytes) throw std::runtime_error(bytes.error().message);
  FilesInMemory files;
  files.files["a.ply"] = std::string(bytes->chars(), bytes->size());
  const auto mesh = core::read_mesh(files, "a.ply");
  if (!mesh) throw std::runtime_error(mesh.error().message);
  return *mesh;
}

}  // namespace hyades::test
