#include "core/scene/shape_makers.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/job/frame_files.h"
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

void note(const ShapeSetting& setting, std::string text) {
  if (setting.notice != nullptr) *setting.notice = std::move(text);
}

/// The mesh of its frame, deforming to that of the next one. Who asks for places only may ask for
/// the frame after the last: the last mesh stays where it was.
Result<Shape> mesh_of_sequence(const ObjectDesc& object, const ShapeSetting& setting,
                               const MeshUse& use) {
  const auto file_of = [&](double frame) {
    return frame_file_at(object.mesh, {setting.time.seconds, frame});
  };
  std::string file = file_of(setting.time.frame);
  const bool places_only = setting.displacement == nullptr;
  if (places_only && !setting.cache.exists(file)) file = file_of(setting.time.frame - 1.0);
  auto loaded = setting.cache.frame_mesh(file, use);
  if (!loaded) return loaded.error();
  Shape shape = shape_of(*loaded);
  const std::string next_file = file_of(setting.time.frame + 1.0);
  if (!(setting.shutter > 0.0F) || !setting.cache.exists(next_file)) return shape;
  auto next = setting.cache.frame_mesh(next_file, use);
  if (!next) return next.error();
  if (same_topology(*shape.mesh, **next)) {
    shape.next = *next;
    shape.reach = setting.shutter;
  } else {
    note(setting, fmt::format("{} and {} have other triangles: while the shutter is open, the mesh "
                              "stands still",
                              file, next_file));
  }
  return shape;
}

Result<Shape> mesh(const ObjectDesc& object, const ShapeSetting& setting) {
  if (setting.displacement != nullptr && is_displaced(object, setting.displacement->looks.time())) {
    auto displaced = displaced_mesh(object, *setting.displacement);
    if (!displaced) return displaced.error();
    if (setting.shutter > 0.0F && is_file_sequence(object.mesh)) {
      note(setting, "its mesh is displaced: while the shutter is open, it does not deform");
    }
    return shape_of(*displaced);
  }
  const auto use = setting.displacement == nullptr && may_be_displaced(object)
                       ? Result<MeshUse>(base_use_of(object, setting.extras))
                       : mesh_use_of(object, setting.extras);
  if (!use) return use.error();
  if (is_file_sequence(object.mesh)) return mesh_of_sequence(object, setting, *use);
  auto loaded = setting.cache.mesh(object.mesh, *use);
  if (!loaded) return loaded.error();
  return shape_of(*loaded);
}

constexpr std::array<NameRow<CurveBasis>, 3> kCurveBases = {{
    {"catmull-rom", CurveBasis::catmull_rom},
    {"bezier", CurveBasis::bezier},
    {"b-spline", CurveBasis::b_spline},
}};

Result<Shape> curves(const ObjectDesc& object, const ShapeSetting& setting) {
  const auto basis = look_up(kCurveBases, object.basis, "basis of curves");
  if (!basis) return basis.error();
  auto loaded = setting.cache.curves(object.curves, (*basis)->value);
  if (!loaded) return loaded.error();
  Shape shape;
  shape.kind = Shape::Kind::curves;
  shape.curves = *loaded;
  return shape;
}

using ShapeMaker = Result<Shape> (*)(const ObjectDesc&, const ShapeSetting&);
constexpr std::array<NameRow<ShapeMaker>, 7> kShapeMakers = {{
    {"sphere", quadric<Shape::Kind::sphere>},
    {"rectangle", rectangle},
    {"disk", quadric<Shape::Kind::disk>},
    {"box", box},
    {"cylinder", quadric<Shape::Kind::cylinder>},
    {"mesh", mesh},
    {"curves", curves},
}};

}  // namespace

Result<Shape> make_shape(const ObjectDesc& object, const ShapeSetting& setting) {
  const auto make = look_up(kShapeMakers, object.shape, "shape");
  if (!make) return make.error();
  return (*make)->value(object, setting);
}

Result<MeshUse> mesh_use_of(const ObjectDesc& object, const MeshExtras& extras) {
  const auto normals = look_up(kMeshNormals, object.smooth, "kind of normals");
  if (!normals) return normals.error();
  MeshUse use((*normals)->value, object.part);
  use.extras = extras;
  return use;
}

bool size_changes(const ObjectDesc& object) {
  return !object.radius.is_constant() || !object.extent.is_constant() ||
         !object.size.is_constant() || !object.height.is_constant();
}

MeshUse base_use_of(const ObjectDesc& object, const MeshExtras& extras) {
  MeshUse use(MeshNormals::file, object.part);
  use.extras = extras;
  use.extras.tangents = false;
  return use;
}

MeshExtras mesh_extras_of(const Job& job) {
  MeshExtras extras;
  extras.tangents =
      std::any_of(job.materials.begin(), job.materials.end(),
                  [](const MaterialDesc& material) { return material.normal_map.has_value(); });
  for (const TextureDesc& texture : job.textures) {
    extras.colors |= std::holds_alternative<textures::VertexColor>(texture.kind);
    extras.second_uvs |= mapping_of(texture).type == "uv1";
  }
  return extras;
}

std::vector<std::string> made_shapes() { return names_of(kShapeMakers); }
std::vector<std::string> made_mesh_normals() { return names_of(kMeshNormals); }
std::vector<std::string> made_curve_bases() { return names_of(kCurveBases); }

}  // namespace hyades::core
