#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/base/vec.h"
#include "import/gltf/json_value.h"

/// A glTF file (Khronos, glTF 2.0 specification) as it was read: all indices are in range, nodes
/// are a forest, accessors lie within their buffers. What is only read when it is asked for
/// (materials, cameras, extensions) stays JSON.
namespace hyades::core {

struct GltfView {
  Bytes bytes;        ///< decompressed where it was compressed
  size_t stride = 0;  ///< bytes from one element to the next; 0: tightly packed
};

enum class GltfComponent : uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

/// Bytes of one component.
size_t size_of(GltfComponent component);

/// Elements that replace some of an accessor's.
struct GltfSparse {
  size_t count = 0;
  GltfComponent index_type = GltfComponent::uint32;
  int index_view = -1;
  size_t index_offset = 0;
  int value_view = -1;
  size_t value_offset = 0;
};

struct GltfAccessor {
  std::string place;  ///< "accessors[3]"
  int view = -1;      ///< -1: all zero, before `sparse`
  size_t offset = 0;
  GltfComponent component = GltfComponent::float32;
  bool normalized = false;
  size_t count = 0;
  size_t components = 1;  ///< 1 to 4; 16 for MAT4
  std::optional<GltfSparse> sparse;
  std::optional<std::array<Vec3, 2>> extent;  ///< of floats with three components: min and max

  size_t element_size() const { return components * size_of(component); }
};

using GltfAttributes = std::map<std::string, int>;  ///< accessor by semantic

/// KHR_draco_mesh_compression of a primitive.
struct GltfDraco {
  int view = -1;
  GltfAttributes attributes;  ///< Draco's id by semantic
};

struct GltfPrimitive {
  std::string place;
  int mode = 4;
  int indices = -1;
  int material = -1;
  GltfAttributes attributes;
  std::vector<GltfAttributes> targets;  ///< of morphing
  std::optional<GltfDraco> draco;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<float> weights;  ///< of the targets, as many as there are
};

/// A node's place in its parent.
struct GltfPlace {
  Vec3 translation{0.0F};
  Vec4 rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< quaternion x, y, z, w
  Vec3 scale{1.0F};
};

struct GltfNode {
  std::string name;
  int parent = -1;
  std::vector<int> children;
  int mesh = -1;
  int skin = -1;
  int camera = -1;
  int light = -1;
  std::optional<Mat4> matrix;  ///< instead of `place`
  GltfPlace place;
  std::vector<float> weights;  ///< instead of the mesh's
  GltfAttributes instances;    ///< EXT_mesh_gpu_instancing: accessor by semantic
};

struct GltfSkin {
  std::string place;
  std::vector<int> joints;
  int inverse_bind = -1;  ///< accessor of matrices; -1: identity
};

struct GltfChannel {
  std::string place;
  int node = -1;
  enum class Path : uint8_t { translation, rotation, scale, weights } path = Path::translation;
  int input = -1;   ///< accessor: times [s]
  int output = -1;  ///< accessor: values
  enum class Interpolation : uint8_t { linear, step, cubic };
  Interpolation interpolation = Interpolation::linear;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfChannel> channels;
};

struct GltfImage {
  std::string name;
  std::string type;  ///< "png" or "jpg"; else what the file says it is: "image/webp"
  int view = -1;     ///< its bytes, or
  Bytes bytes;       ///< these, or
  std::string file;  ///< this file beside the scene's
};

/// Vertices or triangles of meshes and their targets that are made of a file may be this many per
/// byte of its buffers, as some accessors are shared, or sparse; beyond the first millions fewer.
/// Then a file is not meant seriously.
inline constexpr uint64_t kMostElementsPerByte = 64, kMostOfManyPerByte = 16;
inline constexpr uint64_t kManyElements = uint64_t{1} << 24U;

struct GltfModel {
  std::string file;  ///< for messages
  std::shared_ptr<const nlohmann::json> json;
  std::vector<std::string> notes;  ///< what was left out
  size_t buffer_bytes = 0;         ///< of all buffers together
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<int> order;  ///< nodes of the scene, parents before their children
  std::vector<GltfSkin> skins;
  std::vector<GltfAnimation> animations;
  std::vector<GltfImage> images;

  /// The whole document; complaints go to `trouble`.
  JsonValue root(JsonTrouble& trouble) const { return {json.get(), "", trouble}; }
  Error error(const std::string& what) const { return Error{file + ": " + what}; }

  /// Whether so many vertices or triangles are too many for what the file holds.
  bool is_too_much(uint64_t elements) const {
    const uint64_t bytes = uint64_t{buffer_bytes} + 1024;
    return elements >
           std::min(kMostElementsPerByte * bytes, kManyElements + kMostOfManyPerByte * bytes);
  }
};

}  // namespace hyades::core
