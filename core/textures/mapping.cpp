#include "core/textures/mapping.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"
#include "core/geometry/mesh_attributes.h"

namespace hyades::core {
namespace {

constexpr float kInvTwoPi = 0.5F * kInvPi;
constexpr float kTiny = 1e-20F;  ///< squared: of what is on the axis

/// Around the y axis from +x by -z, 0..1.
float around(const Vec3& p) {
  const float turn = atan2(-p.z, p.x) * kInvTwoPi;
  return turn < 0.0F ? turn + 1.0F : turn;
}

Vec3 project(Projection projection, const Vec3& p) {
  switch (projection) {
    case Projection::planar:
      return {p.x, p.y, 0.0F};
    case Projection::spherical:
      return {around(p), atan2(std::sqrt(p.x * p.x + p.z * p.z), -p.y) * kInvPi, 0.0F};
    case Projection::cylindrical:
      return {around(p), p.y, 0.0F};
    case Projection::none:
      break;
  }
  return p;
}

/// How a projection's u and v change by its argument; none of it where they jump.
struct ProjectionGradient {
  Vec3 u{1.0F, 0.0F, 0.0F};
  Vec3 v{0.0F, 1.0F, 0.0F};
};

ProjectionGradient gradient_of(Projection projection, const Vec3& p) {
  ProjectionGradient gradient;
  if (projection == Projection::planar) return gradient;
  const float rho2 = p.x * p.x + p.z * p.z;
  const bool on_axis = !(rho2 > kTiny);
  gradient.u = on_axis ? Vec3(0.0F) : Vec3(p.z, 0.0F, -p.x) * (kInvTwoPi / rho2);
  if (projection == Projection::cylindrical) return gradient;
  const float rho = std::sqrt(rho2);
  gradient.v = on_axis
                   ? Vec3(0.0F)
                   : Vec3(-p.y * p.x / rho, rho, -p.y * p.z / rho) * (kInvPi / (rho2 + p.y * p.y));
  return gradient;
}

}  // namespace

MappedPoint::MappedPoint(const MappingDesc& desc, const TexturePoint& at)
    : desc_(desc), surface_(at.surface) {
  Vec3 source = at.world;
  if (desc.space == MappingSpace::uv) source = {at.uv, 0.0F};
  if (desc.space == MappingSpace::object) source = at.object;
  if (desc.space == MappingSpace::second_uv) {
    source = {at.surface != nullptr ? second_uv(*at.surface) : Vec2(0.0F), 0.0F};
  }
  place_ = transform_point(desc.transform, source);
  coordinate_ = project(desc.projection, place_) * desc.scale + desc.offset;
}

Vec3 MappedPoint::project_step(const Vec3& direction) const {
  if (desc_.projection == Projection::none) return direction;
  const ProjectionGradient g = gradient_of(desc_.projection, place_);
  return {glm::dot(g.u, direction), glm::dot(g.v, direction), 0.0F};
}

Vec3 MappedPoint::project_back(const Vec3& derivative) const {
  if (desc_.projection == Projection::none) return derivative;
  const ProjectionGradient g = gradient_of(desc_.projection, place_);
  return derivative.x * g.u + derivative.y * g.v;
}

void MappedPoint::add_gradient(const Vec3& derivative, ScalarGradient& result) const {
  const Vec3 by_place = project_back(derivative * desc_.scale);
  const Vec3 d = glm::transpose(Mat3(desc_.transform)) * by_place;
  if (desc_.space == MappingSpace::uv) result.d_uv += Vec2(d.x, d.y);
  if (desc_.space == MappingSpace::second_uv && surface_ != nullptr) {
    const auto [by_u, by_v] = second_uv_gradient(*surface_);
    result.d_object += d.x * by_u + d.y * by_v;
  }
  if (desc_.space == MappingSpace::object) result.d_object += d;
  if (desc_.space == MappingSpace::world) result.d_world += d;
}

Vec3 MappedPoint::step(const Vec3& along, const SurfacePoint& surface) const {
  Vec3 source = along;
  if (desc_.space == MappingSpace::object) {
    source = transform_vector(surface.world_to_object, along);
  } else if (desc_.space == MappingSpace::second_uv) {
    const auto [by_u, by_v] = second_uv_gradient(surface);
    const Vec3 object = transform_vector(surface.world_to_object, along);
    source = {glm::dot(by_u, object), glm::dot(by_v, object), 0.0F};
  } else if (desc_.space == MappingSpace::uv) {
    // The least-squares solution of dpdu u + dpdv v = along.
    const float a = glm::dot(surface.dpdu, surface.dpdu);
    const float b = glm::dot(surface.dpdu, surface.dpdv);
    const float c = glm::dot(surface.dpdv, surface.dpdv);
    const float determinant = a * c - b * b;
    if (!(determinant > 0.0F)) return Vec3(0.0F);
    const float x = glm::dot(surface.dpdu, along);
    const float y = glm::dot(surface.dpdv, along);
    source = Vec3(c * x - b * y, a * y - b * x, 0.0F) / determinant;
  }
  return project_step(Mat3(desc_.transform) * source) * desc_.scale;
}

}  // namespace hyades::core
