#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/job/read_sections.h"

namespace hyades::core {

void check_keys(MapReader& reader, EmitDesc& /*emit*/) {
  if (!reader.has("power") || !reader.has("radiance")) return;
  reader.complain(reader.where_of("power"),
                  "emit has both radiance and power, expected one of them");
}

void check_keys(MapReader& reader, ObjectDesc& object) {
  const std::string& shape = object.shape;
  if (shape.empty()) return;
  const bool is_shape = shape != "instance" && shape != "group";
  for (const char* key : {"interior", "exterior", "priority"}) {
    if (has_inside(object) || !is_shape || !reader.has(key)) continue;
    reader.complain(
        reader.where_of(key),
        fmt::format("{} is a {}, which has no inside: {} needs a mesh, a sphere, a box or a "
                    "cylinder with caps",
                    reader.what(), shape == "cylinder" ? "cylinder without caps" : shape, key));
  }
  if (shape == "mesh" || !reader.has("displacement")) return;
  reader.leave_to_others("displacement");
  reader.complain(reader.where_of("displacement"),
                  fmt::format("{} is {} {}, but displacement moves the triangles of a mesh{}",
                              reader.what(), shape == "instance" ? "an" : "a", shape,
                              is_shape ? ": write the shape as a file and give it with mesh"
                                       : ": give it to the meshes in it"));
}

namespace {

void read_object_list(MapReader& reader, std::vector<ObjectDesc>& objects);

constexpr std::array<const char*, 4> kKinds = {"shape", "mesh", "instance", "group"};

/// An object is what its one key of kKinds says; "" after a complaint.
std::string read_shape(MapReader& reader) {
  std::string shape;
  for (const char* kind : kKinds) {
    const YamlNode* node = reader.find(kind);
    if (node == nullptr) continue;
    if (!shape.empty()) {
      reader.complain(node->where, fmt::format("{} has both '{}' and '{}', expected one of them",
                                               reader.what(), shape, kind));
      return "";
    }
    shape = kind;
  }
  if (shape == "shape") {
    shape.clear();
    reader.choice("shape", shape, kShapeNames);
  } else if (shape.empty() && !reader.has_empty()) {
    reader.complain(
        reader.where(),
        fmt::format("{} has none of shape, mesh, instance and group, expected one", reader.what()));
  }
  return shape;
}

void list_keys(MapReader& reader) {
  for (const char* scene : {"gltf", "pbrt", "obj", "animation", "loop"})
    reader.leave_to_others(scene);
  for (const char* kind : kKinds) reader.leave_to_others(kind);
  ObjectDesc object;
  for (const char* shape :
       {"sphere", "rectangle", "disk", "box", "cylinder", "mesh", "instance", "group"}) {
    object.shape = shape;
    ObjectDesc::fields(object, reader);
  }
}

void read_object(MapReader& reader, std::vector<ObjectDesc>& objects, const std::string& name) {
  if (reader.listing()) return list_keys(reader);
  ObjectDesc object;
  object.name = name;
  object.where = reader.where();
  object.shape = read_shape(reader);
  read_fields(reader, object);
  if (object.shape.empty()) return;  // which has been complained about
  reader.finish();
  objects.push_back(std::move(object));
}

void read_object_list(MapReader& reader, std::vector<ObjectDesc>& objects) {
  // Names within groups are not seen from outside.
  const auto kind = reader.path().empty() ? std::optional(NameKind::object) : std::nullopt;
  read_named(reader, "objects", "object", kind, [&](MapReader& object, const std::string& name) {
    read_object(object, objects, name);
  });
}

}  // namespace

void MapReader::children(std::string_view key, std::vector<ObjectDesc>& children) {
  if (listing()) {
    context_.listing->insert({"objects.group", "objects"});
    return;
  }
  map(key, "objects.group", [&](MapReader& group) { read_object_list(group, children); });
}

void read_objects(MapReader& top) { read_object_list(top, top.context().job.objects); }

void read_groups(MapReader& top) {
  read_named(top, "groups", "group", NameKind::group,
             [&](MapReader& reader, const std::string& name) {
               GroupDesc group;
               group.name = name;
               group.where = reader.where();
               reader.require("objects", "a map of objects");
               if (reader.listing()) {
                 reader.leave_to_others("objects");
                 return;
               }
               read_object_list(reader, group.objects);
               reader.finish();
               top.context().job.groups.push_back(std::move(group));
             });
}

}  // namespace hyades::core
