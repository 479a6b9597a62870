#include "core/lights/quadric_light.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <glm/gtc/matrix_inverse.hpp>

#include "core/base/elementary.h"
#include "core/base/warp.h"

namespace hyades::core {

namespace {

struct ShapePlace {
  Vec3 position;
  Vec3 normal;
};

/// A place of the untransformed shape, uniformly by area.
ShapePlace place_on(const Shape& shape, const Vec2& u) {
  switch (shape.kind) {
    case Shape::Kind::disk: {
      const Vec2 disc = shape.radius * square_to_disk(u);
      return {{disc.x, 0.0F, disc.y}, {0.0F, 1.0F, 0.0F}};
    }
    case Shape::Kind::cylinder: {
      const SinCos angle = sin_cos(2.0F * kPi * u.x);
      const Vec3 normal(angle.cos, 0.0F, angle.sin);
      return {shape.radius * normal + Vec3(0.0F, u.y * shape.height, 0.0F), normal};
    }
    default: {
      const Vec3 normal = square_to_uniform_sphere(u);
      return {shape.radius * normal, normal};
    }
  }
}

/// What place_on makes `position` of.
Vec2 square_of(const Shape& shape, const Vec3& position) {
  switch (shape.kind) {
    case Shape::Kind::disk:
      return disk_to_square(Vec2(position.x, position.z) / shape.radius);
    case Shape::Kind::cylinder: {
      const float turn = atan2(position.z, position.x) * (0.5F * kInvPi);
      return {turn < 0.0F ? turn + 1.0F : turn, position.y / shape.height};
    }
    default:
      return uniform_sphere_to_square(position / shape.radius);
  }
}

float shape_area(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::disk:
      return kPi * shape.radius * shape.radius;
    case Shape::Kind::cylinder:
      return 2.0F * kPi * shape.radius * shape.height;
    default:
      return 4.0F * kPi * shape.radius * shape.radius;
  }
}

/// How much `linear` stretches area around a place whose transformed unit normal is `ng`: the
/// cofactor matrix takes normals to normals, scaled by just that, so it is |det| / |M^T ng|.
float stretch(const Mat3& linear, const Vec3& ng) {
  const Vec3 back = glm::transpose(linear) * ng;
  return std::abs(glm::determinant(linear)) / std::sqrt(glm::dot(back, back));
}

}  // namespace

float quadric_clearance(const Vec3& position, const Vec3& ng) {
  const Vec3 size = glm::abs(position);
  return 0x1p-24F * (2.0F * glm::dot(glm::abs(ng), size) + max_component(size));
}

namespace {

/// By area of the untransformed shape, as it stands when the shutter opens.
BrightnessGrid brightness_of(const World& world, uint32_t object, const SurfaceEmission& emission) {
  if (!emission.varies()) return {};
  const Shape& shape = world.placement(object).shape;
  const Mat3 linear(world.transform_at(object, 0.0F));
  const auto at = [&](const Vec2& u) {
    const SurfacePoint on = world.quadric_point(object, place_on(shape, u).position, 0.0F);
    const double area = static_cast<double>(stretch(linear, on.ng));
    return area > 0.0 ? emission.brightness(on) * area : 0.0;
  };
  return {at, emission.look_ups};
}

}  // namespace

QuadricLight::QuadricLight(const World& world, uint32_t object, const SurfaceEmission& emission,
                           double area)
    : QuadricLight(world, object, emission, area, brightness_of(world, object, emission)) {}

QuadricLight::QuadricLight(const World& world, uint32_t object, const SurfaceEmission& emission,
                           double area, BrightnessGrid bright)
    : AreaLight(emission,
                emission.varies()
                    ? bright.mean() * static_cast<double>(shape_area(world.placement(object).shape))
                    : static_cast<double>(luminance(emission.radiance)) * area),
      world_(world),
      object_(object),
      shape_(world.placement(object).shape),
      moves_(world.placement(object).to_world.size() > 1),
      first_(world.transform_at(object, 0.0F)),
      bright_(std::move(bright)) {}

std::optional<LightSample> QuadricLight::sample_direct(const Vec3& from, float time, float /*pick*/,
                                                       const Vec2& u) const {
  if (is_dark()) return std::nullopt;
  const Place place = place_at(time, u);
  return seen_from(from, place);
}

AreaLight::Place QuadricLight::place_at(float time, const Vec2& u) const {
  if (emission().varies()) {
    return place_near(place_on(shape_, bright_.sample(u)).position, time);
  }
  Place place;
  const Mat4 matrix = to_world(time);
  const Mat3 linear(matrix);
  const ShapePlace on_shape = place_on(shape_, u);
  place.on.position = transform_point(matrix, on_shape.position);
  place.on.ng = glm::normalize(glm::inverseTranspose(linear) * on_shape.normal);
  place.on.clearance = quadric_clearance(place.on.position, place.on.ng);
  place.on.time = time;
  place.pdf = 1.0F / (shape_area(shape_) * stretch(linear, place.on.ng));
  return place;
}

AreaLight::Place QuadricLight::place_near(const Vec3& near, float time) const {
  Place place;
  place.on = world_.quadric_point(object_, near, time);
  place.pdf = pdf_place(place.on, Vec3(0.0F));
  return place;
}

std::optional<AreaLight::Place> QuadricLight::choose_place(float time, float /*pick*/,
                                                           const Vec2& u) const {
  return place_at(time, u);
}

float QuadricLight::pdf_place(const SurfacePoint& on, const Vec3& /*direction*/) const {
  if (is_dark()) return 0.0F;
  const float even = 1.0F / (shape_area(shape_) * stretch(Mat3(to_world(on.time)), on.ng));
  if (!emission().varies()) return even;
  const Vec3 in_object = transform_point(on.world_to_object, on.position);
  return even * bright_.pdf(square_of(shape_, in_object));
}

float QuadricLight::pdf_direct(const Vec3& from, const Vec3& /*direction*/,
                               const SurfacePoint& on) const {
  if (is_dark()) return 0.0F;
  return area_to_solid_angle(pdf_place(on, Vec3(0.0F)), from, on.position, on.ng);
}

}  // namespace hyades::core
