#include "import/gltf/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "import/gltf/accessor.h"
#include "import/gltf/draco.h"

namespace hyades::core {

namespace {

/// Floats as vectors of the same size.
template <class T>
std::vector<T> as_vectors(const std::vector<float>& floats) {
  std::vector<T> out(floats.size() / (sizeof(T) / sizeof(float)));
  if (!out.empty()) std::memcpy(out.data(), floats.data(), out.size() * sizeof(T));
  return out;
}

/// Where the numbers of a primitive come from: accessors, or Draco's code.
class Source {
 public:
  Source(const GltfModel& model, const GltfPrimitive& primitive)
      : model_(model), primitive_(primitive) {}

  Status open() {
    if (!primitive_.draco) return {};
    auto decoded = decode_draco(model_, primitive_);
    if (!decoded) return decoded.error();
    decoded_ = std::move(*decoded);
    return {};
  }

  bool has(const char* name) const { return primitive_.attributes.count(name) != 0; }

  Result<std::vector<float>> floats(const char* name, size_t components) const {
    const auto packed = decoded_.attributes.find(name);
    if (packed != decoded_.attributes.end()) {
      if (components != 0 && packed->second.components != components) {
        return wrong(fmt::format("has {} of {} numbers, expected {}", name,
                                 packed->second.components, components));
      }
      return packed->second.values;
    }
    return read_floats(model_, primitive_.attributes.at(name), components);
  }

  size_t components(const char* name) const {
    const auto packed = decoded_.attributes.find(name);
    if (packed != decoded_.attributes.end()) return packed->second.components;
    return model_.accessors[static_cast<size_t>(primitive_.attributes.at(name))].components;
  }

  Result<std::vector<uint32_t>> indices() const {
    if (primitive_.draco) return decoded_.indices;
    return read_whole(model_, primitive_.indices, 1);
  }

  bool has_indices() const { return primitive_.draco || primitive_.indices >= 0; }

  Error wrong(const std::string& what) const { return model_.error(primitive_.place + " " + what); }

 private:
  const GltfModel& model_;
  const GltfPrimitive& primitive_;
  DracoMesh decoded_;
};

template <class T>
Status read_vectors(const Source& source, const char* name, size_t vertices, std::vector<T>& out) {
  if (!source.has(name)) return {};
  auto floats = source.floats(name, sizeof(T) / sizeof(float));
  if (!floats) return floats.error();
  out = as_vectors<T>(*floats);
  if (out.size() != vertices) {
    return source.wrong(fmt::format("has {} positions, but {} of {}", vertices, out.size(), name));
  }
  return {};
}

Status read_colors(const Source& source, size_t vertices, std::vector<Vec4>& out) {
  if (!source.has("COLOR_0")) return {};
  if (source.components("COLOR_0") == 4) return read_vectors(source, "COLOR_0", vertices, out);
  std::vector<Vec3> opaque;
  if (Status s = read_vectors(source, "COLOR_0", vertices, opaque); !s) return s;
  out.reserve(opaque.size());
  for (const Vec3& color : opaque) out.emplace_back(color, 1.0F);
  return {};
}

/// Strips and fans as triangles (glTF 2.0, section 3.7.2.1).
std::vector<std::array<uint32_t, 3>> triangles_of(const std::vector<uint32_t>& corners, int mode) {
  std::vector<std::array<uint32_t, 3>> out;
  if (mode == 4) {
    out.resize(corners.size() / 3);
    if (!out.empty()) std::memcpy(out.data(), corners.data(), out.size() * sizeof(out[0]));
    return out;
  }
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == 5) {
      out.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    } else {
      out.push_back({corners[i + 1], corners[i + 2], corners[0]});
    }
  }
  return out;
}

}  // namespace

Result<GltfGeometry> read_geometry(const GltfModel& model, const GltfPrimitive& primitive) {
  Source source(model, primitive);
  if (!source.has("POSITION")) return source.wrong("has no POSITION");
  if (Status s = source.open(); !s) return s.error();
  auto positions = source.floats("POSITION", 3);
  if (!positions) return positions.error();
  GltfGeometry out;
  out.positions = as_vectors<Vec3>(*positions);
  const size_t n = out.positions.size();
  for (const Status& s :
       {read_vectors(source, "NORMAL", n, out.normals),
        read_vectors(source, "TANGENT", n, out.tangents),
        read_vectors(source, "TEXCOORD_0", n, out.uvs[0]),
        read_vectors(source, "TEXCOORD_1", n, out.uvs[1]), read_colors(source, n, out.colors)}) {
    if (!s) return s.error();
  }
  std::vector<uint32_t> corners;
  if (source.has_indices()) {
    auto indices = source.indices();
    if (!indices) return indices.error();
    corners = std::move(*indices);
    uint32_t largest = 0;
    for (const uint32_t corner : corners) largest = std::max(largest, corner);
    if (!corners.empty() && largest >= n) {
      return source.wrong(fmt::format("has index {}, but there are {} vertices", largest, n));
    }
  } else {
    corners.resize(n);
    for (size_t i = 0; i < n; ++i) corners[i] = static_cast<uint32_t>(i);
  }
  out.triangles = triangles_of(corners, primitive.draco ? 4 : primitive.mode);
  if (out.triangles.empty()) return source.wrong("has no triangles");
  return out;
}

}  // namespace hyades::core
