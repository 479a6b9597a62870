#include "core/job/read_displacement.h"

#include <fmt/format.h>

#include "core/job/read_textures.h"

namespace hyades::core {

void read_displacement(MapReader& reader, ObjectDesc& object) {
  if (!reader.has("displacement") && !reader.listing()) {
    reader.find("displacement");
    return;
  }
  DisplacementDesc displacement;
  read_texture_map(reader, "displacement", "objects.mesh.displacement", displacement.texture,
                   [&](MapReader& map) {
                     map.animated("height", displacement.height, kAnyNumber);
                     map.animated("midlevel", displacement.midlevel, kUnitInterval);
                     map.number("max_edge", displacement.max_edge, kPositive);
                     map.integer("budget", displacement.budget, 1, kMostDisplacedTriangles);
                   });
  object.displacement = displacement;
}

void refuse_displacement(MapReader& reader, const ObjectDesc& object) {
  if (reader.listing() || !reader.has("displacement")) return;
  const YamlNode* node = reader.find("displacement");
  if (node == nullptr) return;
  const bool is_shape = object.shape != "instance" && object.shape != "group";
  reader.complain(node->where,
                  fmt::format("{} is {} {}, but displacement moves the triangles of a mesh{}",
                              reader.what(), object.shape == "instance" ? "an" : "a", object.shape,
                              is_shape ? ": write the shape as a file and give it with mesh"
                                       : ": give it to the meshes in it"));
}

}  // namespace hyades::core
