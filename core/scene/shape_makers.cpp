#include "core/scene/shape_makers.h"

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
Result<Shape> quadric(const ObjectDesc& object, SceneCache&) {
  Shape shape;
  shape.kind = kind;
  shape.radius = object.radius;
  shape.height = object.height;
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

Result<Shape> rectangle(const ObjectDesc& object, SceneCache& cache) {
  return shape_of(cache.made_mesh(
      size_key("rectangle", object.size),
      [](const Vec3& size) {
        return make_rectangle({size.x, size.y});
      },
      object.size));
}

Result<Shape> box(const ObjectDesc& object, SceneCache& cache) {
  return shape_of(cache.made_mesh(
      size_key("box", object.size), [](const Vec3& size) { return make_box(size); }, object.size));
}

Result<Shape> mesh(const ObjectDesc& object, SceneCache& cache) {
  const auto normals = mesh_normals_of(object);
  if (!normals) return normals.error();
  auto loaded = cache.mesh(object.mesh, MeshUse(*normals, object.part));
  if (!loaded) return loaded.error();
  return shape_of(*loaded);
}

using Maker = Result<Shape> (*)(const ObjectDesc&, SceneCache&);
constexpr std::array<NameRow<Maker>, 6> kMakers = {{
    {"sphere", quadric<Shape::Kind::sphere>},
    {"rectangle", rectangle},
    {"disk", quadric<Shape::Kind::disk>},
    {"box", box},
    {"cylinder", quadric<Shape::Kind::cylinder>},
    {"mesh", mesh},
}};

}  // namespace

Result<Shape> make_shape(const ObjectDesc& object, SceneCache& cache) {
  const auto make = look_up(kMakers, object.shape, "shape");
  if (!make) return make.error();
  return (*make)->value(object, cache);
}

Result<MeshNormals> mesh_normals_of(const ObjectDesc& object) {
  const auto normals = look_up(kMeshNormals, object.smooth, "kind of normals");
  if (!normals) return normals.error();
  return (*normals)->value;
}

std::vector<std::string> made_shapes() { return names_of(kMakers); }
std::vector<std::string> made_mesh_normals() { return names_of(kMeshNormals); }

}  // namespace hyades::core
