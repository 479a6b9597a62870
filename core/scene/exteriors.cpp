#include "core/scene/exteriors.h"

#include <optional>

#include "core/scene/media_around.h"

namespace hyades::core {
namespace {

/// A place just outside of the surface of placement `object` when the shutter opens; nothing where
/// it has no surface.
std::optional<Vec3> place_outside(const World& world, uint32_t object) {
  constexpr float kJustOutside = 1.001F;
  const Shape& shape = world.placement(object).shape;
  if (shape.kind != Shape::Kind::mesh) {
    const Vec3 side(kJustOutside * shape.radius, 0.0F, 0.0F);
    const Vec3 at =
        shape.kind == Shape::Kind::cylinder ? Vec3(0.0F, 0.5F * shape.height, 0.0F) : Vec3(0.0F);
    return transform_point(world.transform_at(object, 0.0F), at + side);
  }
  for (uint32_t i = 0; i < shape.mesh->triangles.size(); ++i) {
    const SurfacePoint point = world.triangle_point(object, i, 1.0F / 3.0F, 1.0F / 3.0F, 0.0F);
    const Vec3 normal = glm::cross(point.dpdu, point.dpdv);
    if (glm::dot(normal, normal) > 0.0F) return offset_position(point, point.ng);
  }
  return std::nullopt;
}

class Exteriors {
 public:
  Exteriors(const Job& job, Appearance& looks, Scene& scene)
      : job_(job), looks_(looks), scene_(scene) {}

  Status settle(const FlatObject& object, uint32_t number) {
    const std::string& name = object.desc->exterior;
    auto exterior = looks_.medium(name);
    if (!exterior) return at_object(object, exterior.error().in("exterior"));
    const auto place = place_outside(*scene_.world, number);
    if (!place) return {};
    const MediumStack around = media_around(scene_, *place, 0.0F);
    if (around.empty() && job_.atmosphere.empty() && !scene_.atmosphere)
      scene_.atmosphere = *exterior;
    const Medium* there = around.empty() ? scene_.atmosphere.get() : around.medium();
    if (there == exterior->get()) return {};
    return at_object(object, Error{"its exterior is '" + name + "', but outside of it there is " +
                                   name_of(there) + ", expected the same"});
  }

 private:
  std::string name_of(const Medium* medium) {
    if (medium == nullptr) return "nothing";
    for (const MediumDesc& desc : job_.media) {
      const auto made = looks_.medium(desc.name);
      if (made && made->get() == medium) return "'" + desc.name + "'";
    }
    return "a medium of another body";
  }

  const Job& job_;
  Appearance& looks_;
  Scene& scene_;
};

}  // namespace

Status settle_exteriors(const Job& job, const std::vector<FlatObject>& objects, Appearance& looks,
                        Scene& scene) {
  Exteriors exteriors(job, looks, scene);
  for (uint32_t i = 0; i < objects.size(); ++i) {
    if (objects[i].desc->exterior.empty() || objects[i].body != i) continue;
    if (auto done = exteriors.settle(objects[i], i); !done) return done;
  }
  return {};
}

}  // namespace hyades::core
