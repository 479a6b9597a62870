#include "core/scene/shape_makers.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/name_table.h"

namespace hyades::core {
namespace {

constexpr std::array<NameRow<MeshNormals>, 3> kMeshNormals = {{
    {"file", MeshNormals::file},
    {"flat", MeshNormals::flat},
    {"smooth", MeshNormals::smooth},
}};

template <Shape::Kind kind>
Result<Shape> quadric(const ObjectDesc& object, const ShapeSetting& setting) {
  Shape shape;
  shape.kind = kind;
  shape.radius = object.radius.at(setting.time);
  shape.height = object.height.at(setting.time);
  return shape;
}

Shape shape_of(std::shared_ptr<const TriangleMesh> mesh) {
  Shape shape;
  shape.mesh = std::move(mesh);
  return shape;
}

std::string size_key(const char* kind, const Vec3& size) {
  return fmt::format("{} {} {} {}", kind, size.x, size.y, size.z);
}

Result<Shape> rectangle(const ObjectDesc& object, const ShapeSetting& setting) {
  const Vec3 size(object.extent.at(setting.time), 0.0F);
  return shape_of(setting.cache.made_mesh(
      size_key("rectangle", size),
      [](const Vec3& extent) {
        return make_rectangle({extent.x, extent.y});
      },
      size));
}

Result<Shape> box(const ObjectDesc& object, const ShapeSetting& setting) {
  const Vec3 size = object.size.at(setting.time);
  return shape_of(setting.cache.made_mesh(
      size_key("box", size), [](const Vec3& extent) { return make_box(extent); }, size));
}

Result<Shape> mesh(const ObjectDesc& object, const ShapeSetting& setting) {
  if (setting.displacement != nullptr && is_displaced(object, setting.displacement->looks.time())) {
    auto displaced = displaced_mesh(object, *setting.displacement);
    if (!displaced) return displaced.error();
    return shape_of(*displaced);
  }
  const auto use = setting.displacement == nullptr && may_be_displaced(object)
                       ? Result<MeshUse>(base_use_of(object))
                       : mesh_use_of(object, setting.tangents);
  if (!use) return use.error();
  auto loaded = setting.cache.mesh(object.mesh, *use);
  if (!loaded) return loaded.error();
  return shape_of(*loaded);
}

using Maker = Result<Shape> (*)(const ObjectDesc&, const ShapeSetting&);
constexpr std::array<NameRow<Maker>, 6> kMakers = {{
    {"sphere", quadric<Shape::Kind::sphere>},
    {"rectangle", rectangle},
    {"disk", quadric<Shape::Kind::disk>},
    {"box", box},
    {"cylinder", quadric<Shape::Kind::cylinder>},
    {"mesh", mesh},
}};

}  // namespace

Result<Shape> make_shape(const ObjectDesc& object, const ShapeSetting& setting) {
  const auto make = look_up(kMakers, object.shape, "shape");
  if (!make) return make.error();
  return (*make)->value(object, setting);
}

Result<MeshUse> mesh_use_of(const ObjectDesc& object, bool tangents) {
  const auto normals = look_up(kMeshNormals, object.smooth, "kind of normals");
  if (!normals) return normals.error();
  MeshUse use((*normals)->value, object.part);
  use.tangents = tangents;
  return use;
}

bool size_changes(const ObjectDesc& object) {
  return !object.radius.is_constant() || !object.extent.is_constant() ||
         !object.size.is_constant() || !object.height.is_constant();
}

MeshUse base_use_of(const ObjectDesc& object) { return {MeshNormals::file, object.part}; }

bool has_normal_maps(const Job& job) {
  return std::any_of(job.materials.begin(), job.materials.end(),
                     [](const MaterialDesc& material) { return material.normal_map.has_value(); });
}

std::vector<std::string> made_shapes() { return names_of(kMakers); }
std::vector<std::string> made_mesh_normals() { return names_of(kMeshNormals); }

}  // namespace hyades::core
