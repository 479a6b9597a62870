#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "import/gltf/model.h"

namespace hyades::core {

/// The triangles of a primitive, as the file has them; vectors are per vertex, or empty.
struct GltfGeometry {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec4> tangents;            ///< w: handedness
  std::array<std::vector<Vec2>, 2> uvs;  ///< of the file: v from top to bottom
  std::vector<Vec4> colors;              ///< linear, with alpha
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// The bones of each vertex: four joints of the skin for each set of them, and how much each
/// counts.
struct GltfBones {
  size_t each = 0;               ///< joints per vertex
  std::vector<uint32_t> joints;  ///< each of them per vertex, below the skin's count
  std::vector<float> weights;    ///< likewise; they add up to 1
};

/// Whether a primitive has triangles (and not points or lines).
inline bool has_triangles(const GltfPrimitive& primitive) { return primitive.mode >= 4; }

/// Reads a primitive. Errors name it: attributes of different lengths, indices beyond the vertices,
/// numbers that are not finite.
Result<GltfGeometry> read_geometry(const GltfModel& model, const GltfPrimitive& primitive);

/// Reads JOINTS_n and WEIGHTS_n; empty where there are none.
Result<GltfBones> read_bones(const GltfModel& model, const GltfPrimitive& primitive,
                             size_t vertices, size_t joints);

/// Adds morph targets, each by its weight.
Status morph(const GltfModel& model, const GltfPrimitive& primitive,
             const std::vector<float>& weights, GltfGeometry& geometry);

/// Moves each vertex by the mean of its joints' matrices (linear blend skinning).
void skin(const GltfBones& bones, const std::vector<Mat4>& joints, GltfGeometry& geometry);

}  // namespace hyades::core
