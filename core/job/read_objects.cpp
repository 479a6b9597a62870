#include <fmt/format.h>

#include <array>

#include "core/base/text.h"
#include "core/job/kinds.h"
#include "core/job/read_overrides.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

void read_emit(MapReader& reader, ObjectDesc& object) {
  reader.enter_section("objects.shapes");
  EmitDesc emit;
  reader.map("emit", "objects.emit", [&](MapReader& map) {
    map.color_input("color", emit.color, kNotNegative);
    map.animated("radiance", emit.amount, kNotNegative);
    map.animated("power", emit.amount, kNotNegative);
    if (map.has("power")) emit.unit = EmitDesc::Unit::power;
    if (map.has("power") && map.has("radiance")) {
      map.complain(map.find("power")->where,
                   "emit has both radiance and power, expected one of them");
    }
    map.flag("two_sided", emit.two_sided);
    map.light_group("light_group", emit.light_group);
  });
  if (reader.has("emit")) object.emit = emit;
}

void read_body(MapReader& reader, ObjectDesc& object) {
  reader.enter_section("objects.bodies");
  reader.name_of("interior", object.interior, NameKind::medium);
  reader.name_of("exterior", object.exterior, NameKind::medium);
  reader.integer("priority", object.priority, -1000, 1000);
}

/// Shapes that nothing can be inside of.
void refuse_body(MapReader& reader, const ObjectDesc& object) {
  if (has_inside(object)) return;
  for (const char* key : {"interior", "exterior", "priority"}) {
    const YamlNode* node = reader.find(key);
    if (node == nullptr) continue;
    reader.complain(
        node->where,
        fmt::format("{} is a {}, which has no inside: {} needs a mesh, a sphere, a box or a "
                    "cylinder with caps",
                    reader.what(),
                    object.shape == "cylinder" ? "cylinder without caps" : object.shape, key));
  }
}

void read_sphere(MapReader& reader, ObjectDesc& object) {
  reader.animated("radius", object.radius, kPositive);
}

void read_rectangle(MapReader& reader, ObjectDesc& object) {
  reader.animated("size", object.extent, kPositive);
}

void read_box(MapReader& reader, ObjectDesc& object) {
  reader.animated("size", object.size, kPositive);
}

void read_cylinder(MapReader& reader, ObjectDesc& object) {
  reader.animated("radius", object.radius, kPositive);
  reader.animated("height", object.height, kPositive);
  reader.flag("caps", object.caps);
}

struct ShapeRow {
  const char* name;
  void (*read)(MapReader& reader, ObjectDesc& object);
};

constexpr std::array<ShapeRow, 5> kShapes = {{
    {"sphere", read_sphere},
    {"rectangle", read_rectangle},
    {"disk", read_sphere},
    {"box", read_box},
    {"cylinder", read_cylinder},
}};

const std::array<std::string, 3> kMeshNormals = {"file", "flat", "smooth"};

void read_shape(MapReader& reader, ObjectDesc& object) {
  std::vector<std::string> names;
  for (const ShapeRow& row : kShapes) names.emplace_back(row.name);
  std::string shape;
  reader.choice("shape", shape, names);
  read_emit(reader, object);
  for (const ShapeRow& row : kShapes) {
    if (shape != row.name && !reader.listing()) continue;
    object.shape = row.name;
    reader.enter_section(std::string("objects.") + row.name);
    row.read(reader, object);
  }
  if (object.shape.empty()) return;
  read_body(reader, object);
  if (!reader.listing()) refuse_body(reader, object);
}

void read_mesh(MapReader& reader, ObjectDesc& object) {
  object.shape = "mesh";
  reader.mesh_file("mesh", object.mesh);
  read_emit(reader, object);
  reader.enter_section("objects.mesh");
  reader.choice("normals", object.smooth, kMeshNormals);
  reader.text("part", object.part, "the name of a material in the mesh's file (usemtl)");
  reader.map("displacement", "objects.mesh.displacement", object.displacement);
  reader.enter_section("objects.mesh");
  read_body(reader, object);
}

/// What moves the triangles of a mesh, beside anything else.
void refuse_displacement(MapReader& reader, const ObjectDesc& object) {
  if (!reader.has("displacement")) return;
  reader.leave_to_others("displacement");
  const bool is_shape = object.shape != "instance" && object.shape != "group";
  reader.complain(reader.where_of("displacement"),
                  fmt::format("{} is {} {}, but displacement moves the triangles of a mesh{}",
                              reader.what(), object.shape == "instance" ? "an" : "a", object.shape,
                              is_shape ? ": write the shape as a file and give it with mesh"
                                       : ": give it to the meshes in it"));
}

void read_instance(MapReader& reader, ObjectDesc& object) {
  object.shape = "instance";
  reader.name_of("instance", object.instance_of, NameKind::group);
  reader.enter_section("objects.instance");
  reader.file("places", object.places);
}

void read_object_list(MapReader& reader, std::vector<ObjectDesc>& objects);

void read_group(MapReader& reader, ObjectDesc& object) {
  object.shape = "group";
  reader.map("group", "objects.group",
             [&](MapReader& map) { read_object_list(map, object.children); });
}

struct KindRow {
  const char* key;
  void (*read)(MapReader& reader, ObjectDesc& object);
};

const std::array<KindRow, 4> kKinds = {{
    {"shape", read_shape},
    {"mesh", read_mesh},
    {"instance", read_instance},
    {"group", read_group},
}};

/// An object is what its one key of kKinds says.
const KindRow* find_kind(MapReader& reader) {
  const KindRow* kind = nullptr;
  for (const KindRow& row : kKinds) {
    const YamlNode* node = reader.find(row.key);
    if (node == nullptr) continue;
    if (kind != nullptr) {
      reader.complain(node->where, fmt::format("{} has both '{}' and '{}', expected one of them",
                                               reader.what(), kind->key, row.key));
      return nullptr;
    }
    kind = &row;
  }
  if (kind == nullptr) {
    reader.complain(
        reader.where(),
        fmt::format("{} has none of shape, mesh, instance and group, expected one", reader.what()));
  }
  return kind;
}

void read_object(MapReader& reader, std::vector<ObjectDesc>& objects, const std::string& name) {
  ObjectDesc object;
  object.name = name;
  object.where = reader.where();
  reader.name_of("material", object.material, NameKind::material);
  read_overrides(reader, object);
  reader.place(object.transform, object.at);
  reader.flag("visible_to_camera", object.visible_to_camera);
  if (reader.listing()) {
    for (const KindRow& row : kKinds) {
      reader.enter_section("objects");
      if (std::string_view(row.key) != "group") row.read(reader, object);
    }
    reader.enter_section("objects");
    for (const char* scene : {"gltf", "pbrt", "obj", "animation", "loop"})
      reader.leave_to_others(scene);
    reader.leave_to_others("group");
    reader.context().listing->insert({"objects.group", "objects"});
    return;
  }
  const KindRow* kind = find_kind(reader);
  if (kind == nullptr) return;
  kind->read(reader, object);
  if (object.shape != "mesh") refuse_displacement(reader, object);
  if (object.shape.empty()) return;  // an unknown shape, which has been complained about
  reader.enter_section("objects." + object.shape);
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

std::vector<std::string> shape_names() {
  std::vector<std::string> names = {"mesh"};
  for (const ShapeRow& row : kShapes) names.emplace_back(row.name);
  return names;
}

bool has_inside(const ObjectDesc& object) {
  return object.shape == "mesh" || object.shape == "sphere" || object.shape == "box" ||
         (object.shape == "cylinder" && object.caps);
}

std::span<const std::string> mesh_normals_names() { return kMeshNormals; }

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
