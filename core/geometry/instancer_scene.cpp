#include "core/geometry/instancer_scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/embree_world.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/placement_check.h"

namespace hyades::core {
namespace {

Affine affine_of(const PlaceMatrix& m) {
  return {glm::dmat3(Vec3d(m[0]), Vec3d(m[1]), Vec3d(m[2])), Vec3d(m[3])};
}

/// `ray` as it is in the space of a copy; its distances stay what they are.
RTCRay transformed(const RTCRay& ray, const Affine& to_copy) {
  const Vec3 origin(to_copy.point(Vec3d(ray.org_x, ray.org_y, ray.org_z)));
  const Vec3 direction(to_copy.vector(Vec3d(ray.dir_x, ray.dir_y, ray.dir_z)));
  RTCRay out = ray;
  out.org_x = origin.x;
  out.org_y = origin.y;
  out.org_z = origin.z;
  out.dir_x = direction.x;
  out.dir_y = direction.y;
  out.dir_z = direction.z;
  return out;
}

}  // namespace

InstancerScene::InstancerScene(std::shared_ptr<const PointInstancer> instancer,
                               std::vector<Placement> members,
                               std::shared_ptr<const EmbreeWorld> inner)
    : instancer_(std::move(instancer)),
      members_(std::move(members)),
      inner_(std::move(inner)),
      motion_(instancer_->to_world) {}

Status InstancerScene::build() {
  const size_t copies = instancer_->places->size();
  SceneBuilder builder;
  RTCGeometry geometry = rtcNewGeometry(builder.device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(copies));
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(motion_.steps().size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, bounds_callback, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_callback);
  rtcSetGeometryOccludedFunction(geometry, occluded_callback);
  rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
  builder.attach(geometry, 0);
  auto scene = builder.commit();
  if (!scene) return scene.error();
  scene_ = *scene;
  bounds_ = bounds_of(inner_->bounds());
  return {};
}

Bounds InstancerScene::bounds_of(const Bounds& inner) const {
  const size_t copies = instancer_->places->size();
  std::vector<Bounds> parts(chunk_count(copies));
  for_chunks(copies, [&](size_t begin, size_t end) {
    Bounds b;
    for (size_t i = begin; i < end; ++i) {
      for (size_t step = 0; step < motion_.steps().size(); ++step) {
        b.include(bounds_of_copy(static_cast<uint32_t>(i), step, inner));
      }
    }
    parts[begin / kChunk] = b;
  });
  Bounds all;
  for (const Bounds& b : parts) all.include(b);
  return all;
}

bool InstancerScene::is_of(const PointInstancer& instancer,
                           const std::vector<Placement>& members) const {
  return instancer.places == instancer_->places && instancer.to_world == instancer_->to_world &&
         std::equal(members.begin(), members.end(), members_.begin(), members_.end(),
                    [](const Placement& a, const Placement& b) { return same_placement(a, b); });
}

CopyPose InstancerScene::pose(uint32_t copy, float time) const {
  const Affine place = affine_of((*instancer_->places)[copy]);
  const Affine to_world = motion_.at(time) * place;
  return {to_world, to_world.inverse()};
}

Bounds InstancerScene::bounds_of_copy(uint32_t copy, size_t step, const Bounds& inner) const {
  const Affine to_world = motion_.steps()[step] * affine_of((*instancer_->places)[copy]);
  return transform_bounds(to_world, inner);
}

size_t InstancerScene::memory() const {
  return instancer_->places->capacity() * sizeof(PlaceMatrix) + scene_->memory() + inner_->memory();
}

void InstancerScene::bounds_callback(const RTCBoundsFunctionArguments* args) {
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  const Bounds b =
      instancer.bounds_of_copy(args->primID, args->timeStep, instancer.inner_->bounds());
  *args->bounds_o = {b.lower.x, b.lower.y, b.lower.z, 0.0F, b.upper.x, b.upper.y, b.upper.z, 0.0F};
}

// Rays come one at a time here (rtcIntersect1, rtcOccluded1), so N is 1.
void InstancerScene::intersect_callback(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& found = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  RTCRayHit query;
  query.ray = transformed(found.ray, instancer.pose(args->primID, found.ray.time).to_copy);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace_nearest(instancer.inner_->scene(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  found.ray.tfar = query.ray.tfar;
  // Which copy and which of its objects travel where the normal would, which nobody reads.
  found.hit.Ng_x = std::bit_cast<float>(args->primID);
  found.hit.Ng_y = std::bit_cast<float>(instancer.inner_->object_of(query.hit));
  found.hit.u = 0.0F;
  found.hit.v = 0.0F;
  found.hit.primID = query.hit.primID;
  found.hit.geomID = args->geomID;
  found.hit.instID[0] = args->context->instID[0];
}

void InstancerScene::occluded_callback(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  RTCRay query = transformed(ray, instancer.pose(args->primID, ray.time).to_copy);
  trace_any(instancer.inner_->scene(), query);
  if (query.tfar < 0.0F) ray.tfar = -std::numeric_limits<float>::infinity();
}

CopyHit copy_hit(const RTCHit& hit) {
  return {std::bit_cast<uint32_t>(hit.Ng_x), std::bit_cast<uint32_t>(hit.Ng_y)};
}

}  // namespace hyades::core
