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
  const bool is_shape = shape != "instance" && shape != "group" && shape != "curves";
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
  reader.complain(
      reader.where_of("displacement"),
      fmt::format("{} is {} {}, but displacement moves the triangles of a mesh{}", reader.what(),
                  shape == "instance" ? "an"
                  : shape == "curves" ? "of"
                                      : "a",
                  shape,
                  is_shape            ? ": write the shape as a file and give it with mesh"
                  : shape == "curves" ? ", which they are not"
                                      : ": give it to the meshes in it"));
}

namespace {

void read_object_list(MapReader& reader, std::vector<ObjectDesc>& objects);

constexpr std::array<const char*, 5> kKinds = {"shape", "mesh", "curves", "instance", "group"};

/// What somebody may have meant who did not say what an object is.
std::string likely_kind(const MapReader& reader) {
  if (reader.has("type")) return ", did you mean 'shape' instead of 'type'?";
  if (reader.has("file")) return ", did you mean 'mesh' instead of 'file'?";
  const std::string joined = reader.key_without_space();
  return joined.empty() ? "" : "; in '" + joined + "' a space belongs after the colon";
}

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
        fmt::format("{} has none of shape, mesh, curves, instance and group, expected one{}",
                    reader.what(), likely_kind(reader)));
  }
  return shape;
}

/// Scenes of other tools are read elsewhere (scene_objects.h); what is left of them are groups.
void list_scene_keys(MapReader& reader) {
  ObjectDesc scene;
  for (const char* kind : {"gltf", "pbrt", "obj"}) {
    reader.enter_type(std::string("objects.") + kind);
    ObjectDesc::fields(scene, reader);
    reader.enter_section("objects");
    reader.tell(kind, {.takes = "file", .required = true});
    if (kind != std::string_view("gltf")) continue;
    reader.tell("animation", {.takes = "text"});
    reader.tell("loop", {.takes = "switch", .start = "false"});
  }
}

void list_keys(MapReader& reader) {
  ObjectDesc object;
  reader.tell("shape", {.takes = "choice", .names = {kShapeNames.begin(), kShapeNames.end()}});
  for (const char* shape :
       {"sphere", "rectangle", "disk", "box", "cylinder", "mesh", "curves", "instance", "group"}) {
    object.shape = shape;
    reader.enter_type("objects." + object.shape);
    ObjectDesc::fields(object, reader);
    reader.enter_section("objects");
    for (const char* kind : {"mesh", "curves", "instance", "group"}) {
      if (object.shape == kind) reader.require(kind, "");
    }
  }
  list_scene_keys(reader);
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
    tell(key, {.takes = "map", .below = "objects.group"});
    context_.listing->at("objects.group", {"objects.group", "objects"}) = {.takes = "entries",
                                                                           .below = "objects"};
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
                 reader.tell("objects", {.takes = "entries", .below = "objects"});
                 return;
               }
               read_object_list(reader, group.objects);
               reader.finish();
               top.context().job.groups.push_back(std::move(group));
             });
}

}  // namespace hyades::core
