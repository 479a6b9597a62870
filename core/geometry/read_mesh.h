#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// Reads an OBJ or PLY (ASCII, binary little- or big-endian) mesh, told apart by content, perhaps
/// packed by gzip. Polygons
/// are triangulated; vertices without a face are dropped; OBJ vertices with several normals or UVs
/// are split. Errors name the file and, for text, the line: truncated data, indices out of range,
/// non-finite positions, absurd counts (checked against the file's size before memory is taken).
Result<std::shared_ptr<TriangleMesh>> read_mesh(AssetResolver& assets,
                                                const std::string& reference);

/// The triangles of an OBJ file that have one material (usemtl).
struct MeshPart {
  std::string name;  ///< the material's; kNoMaterial where the file names none
  std::shared_ptr<const TriangleMesh> mesh;
};

inline constexpr const char* kNoMaterial = "default";

struct MeshParts {
  std::vector<MeshPart> parts;         ///< in order of first use; of a file with triangles
  std::vector<std::string> libraries;  ///< what follows each mtllib: files of materials
  uint64_t left_out = 0;  ///< points, lines, curves and faces of less than three corners of an OBJ
};

/// Reads a mesh cut into its materials. A PLY file is one part. Errors as read_mesh's.
Result<MeshParts> read_mesh_parts(AssetResolver& assets, const std::string& reference);

}  // namespace hyades::core
