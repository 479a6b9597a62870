#include "core/geometry/embree_geometry.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/geometry/instancer_scene.h"
#include "core/geometry/placed_world.h"

namespace hyades::core {
namespace {

RTCBounds to_embree(const Bounds& b) {
  return {b.lower.x, b.lower.y, b.lower.z, 0.0F, b.upper.x, b.upper.y, b.upper.z, 0.0F};
}

void quadric_bounds_callback(const RTCBoundsFunctionArguments* args) {
  const auto& object = *static_cast<const PlacedObject*>(args->geometryUserPtr);
  const Bounds b =
      quadric_bounds(object.motion().steps()[args->timeStep], object.placement().shape);
  *args->bounds_o = to_embree(b);
}

RTCGeometryType curve_type(CurveBasis basis) {
  switch (basis) {
    case CurveBasis::bezier:
      return RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE;
    case CurveBasis::b_spline:
      return RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE;
    default:
      return RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE;
  }
}

/// The nearest distance at which `ray` meets the quadric within its interval, as Embree wants it.
std::optional<double> meet(const PlacedObject& object, const RTCRay& ray) {
  const Affine m = object.to_object_at(ray.time);
  const Vec3d origin = m.point(Vec3d(ray.org_x, ray.org_y, ray.org_z));
  const Vec3d direction = m.vector(Vec3d(ray.dir_x, ray.dir_y, ray.dir_z));
  return meet_quadric(object.quadric(), origin, direction, static_cast<double>(ray.tnear),
                      static_cast<double>(ray.tfar));
}

// Rays come one at a time here (rtcIntersect1, rtcOccluded1), so N is 1.
void intersect_quadric(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto t = meet(*static_cast<const PlacedObject*>(args->geometryUserPtr), ray_hit.ray);
  if (!t) return;
  ray_hit.ray.tfar = static_cast<float>(*t);
  ray_hit.hit.u = 0.0F;
  ray_hit.hit.v = 0.0F;
  ray_hit.hit.primID = args->primID;
  ray_hit.hit.geomID = args->geomID;
  ray_hit.hit.instID[0] = args->context->instID[0];
}

void occlude_quadric(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  if (meet(*static_cast<const PlacedObject*>(args->geometryUserPtr), ray)) {
    ray.tfar = -std::numeric_limits<float>::infinity();
  }
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

RTCScene scene_of(const InstancerScene& instancer) {
  return static_cast<const EmbreeScene&>(instancer.inner().scene()).handle();
}

void copies_bounds_callback(const RTCBoundsFunctionArguments* args) {
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  *args->bounds_o =
      to_embree(instancer.bounds_of_copy(args->primID, args->timeStep, instancer.inner().bounds()));
}

void intersect_copy(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& found = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  const auto inner =
      meet_nearest(scene_of(instancer),
                   transformed(found.ray, instancer.pose(args->primID, found.ray.time).to_copy));
  if (!inner) return;
  found.ray.tfar = static_cast<float>(inner->t);
  // Which copy and which of its objects travel where the normal would, which nobody reads.
  found.hit.Ng_x = std::bit_cast<float>(args->primID);
  found.hit.Ng_y = std::bit_cast<float>(instancer.inner().object_of(*inner));
  found.hit.u = 0.0F;
  found.hit.v = 0.0F;
  found.hit.primID = inner->primitive;
  found.hit.geomID = args->geomID;
  found.hit.instID[0] = args->context->instID[0];
}

void occlude_copy(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const auto& instancer = *static_cast<const InstancerScene*>(args->geometryUserPtr);
  RTCRay query = transformed(ray, instancer.pose(args->primID, ray.time).to_copy);
  trace_any(scene_of(instancer), query);
  if (query.tfar < 0.0F) ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

RTCGeometry new_mesh_geometry(RTCDevice device, const MeshBuffers& buffers, unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(buffers.steps.size()));
  for (size_t i = 0; i < buffers.steps.size(); ++i) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(i),
                               RTC_FORMAT_FLOAT3, buffers.steps[i], 0, sizeof(Vec3),
                               buffers.mesh().positions.size());
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             buffers.triangles, 0, sizeof(buffers.triangles[0]),
                             buffers.mesh().triangles.size());
  rtcSetGeometryMask(geometry, mask);
  return geometry;
}

RTCGeometry new_curve_geometry(RTCDevice device, const CurveSet& curves, unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, curve_type(curves.basis));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                             curves.points.data(), 0, sizeof(Vec4), curves.points.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                             curves.pieces.data(), 0, sizeof(uint32_t), curves.pieces.size());
  rtcSetGeometryMask(geometry, mask);
  return geometry;
}

RTCGeometry new_quadric_geometry(RTCDevice device, const PlacedObject& object, unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(object.motion().steps().size()));
  rtcSetGeometryUserData(geometry, const_cast<PlacedObject*>(&object));
  rtcSetGeometryBoundsFunction(geometry, quadric_bounds_callback, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_quadric);
  rtcSetGeometryOccludedFunction(geometry, occlude_quadric);
  rtcSetGeometryMask(geometry, mask);
  return geometry;
}

RTCGeometry new_instance_geometry(RTCDevice device, RTCScene scene, const Motion& motion,
                                  unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, scene);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(motion.steps().size()));
  for (size_t i = 0; i < motion.steps().size(); ++i) {
    const Mat4 m = motion.steps()[i].to_mat4();
    rtcSetGeometryTransform(geometry, static_cast<unsigned>(i), RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                            &m[0][0]);
  }
  rtcSetGeometryMask(geometry, mask);
  return geometry;
}

RTCGeometry new_copies_geometry(RTCDevice device, const InstancerScene& copies) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, copies.copy_count());
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(copies.motion().steps().size()));
  rtcSetGeometryUserData(geometry, const_cast<InstancerScene*>(&copies));
  rtcSetGeometryBoundsFunction(geometry, copies_bounds_callback, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_copy);
  rtcSetGeometryOccludedFunction(geometry, occlude_copy);
  rtcSetGeometryMask(geometry, kAllRays);
  return geometry;
}

}  // namespace hyades::core
