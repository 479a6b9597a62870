#include "core/geometry/embree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/base/fp_mode.h"
#include "core/geometry/embree_geometry.h"
#include "core/geometry/isa.h"

namespace hyades::core {
namespace {

std::atomic<size_t> held_bytes{0};
std::atomic<size_t> limit_bytes{0};

/// Embree calls this before it takes memory and after it gives some back; false refuses.
bool monitor_memory(void*, ssize_t bytes, bool after) {
  const size_t change = static_cast<size_t>(bytes);
  const size_t held = held_bytes.fetch_add(change) + change;
  const size_t limit = limit_bytes.load(std::memory_order_relaxed);
  if (bytes <= 0 || limit == 0 || held <= limit) return true;
  if (!after) held_bytes.fetch_sub(change);
  return false;
}

std::string name_of(RTCError error) {
  switch (error) {
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "the processor lacks what it needs";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

/// Held while a scene is built or released, so that a change of held_bytes belongs to one scene. It
/// guards no member (core/base/mutex.h).
std::mutex& build_mutex() {
  static std::mutex* mutex = new std::mutex;
  return *mutex;
}

struct Device {
  RTCDevice handle = nullptr;
  std::string isa;
};

Device make_device() {
  for (const char* isa : {"avx2", "sse4.2"}) {
    const std::string config = std::string("verbose=0,isa=") + isa;
    if (RTCDevice handle = rtcNewDevice(config.c_str())) {
      rtcSetDeviceMemoryMonitorFunction(handle, monitor_memory, nullptr);
      return {handle, isa};
    }
  }
  return {};
}

const Device& device() {
  static const Device made = make_device();
  return made;
}

RTCRay to_embree(const Ray& ray, RayKind kind, float t_min) {
  RTCRay r;
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = t_min;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = std::clamp(ray.time, 0.0F, 1.0F);
  r.tfar = ray.t_max;
  r.mask = static_cast<unsigned>(kind);
  r.id = 0;
  r.flags = 0;
  return r;
}

RTCScene handle_of(const RayScene& scene) {
  return static_cast<const EmbreeScene&>(scene).handle();
}

Error no_device() {
  return {"Embree " + embree_version() +
          " cannot start: it needs a processor with AVX2 or SSE 4.2 (" +
          name_of(rtcGetDeviceError(nullptr)) + ")"};
}

}  // namespace

Result<RTCDevice> embree_device() {
  if (device().handle == nullptr) return no_device();
  return device().handle;
}

Result<std::string> embree_isa() {
  if (device().handle == nullptr) return no_device();
  return device().isa;
}

std::string embree_version() { return RTC_VERSION_STRING; }

std::string loaded_embree_version() {
  if (device().handle == nullptr) return {};
  const auto version = static_cast<int>(  // 31305 for 3.13.5
      rtcGetDeviceProperty(device().handle, RTC_DEVICE_PROPERTY_VERSION));
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

size_t embree_memory() { return held_bytes.load(); }

void limit_embree_memory(size_t bytes) { limit_bytes.store(bytes); }

EmbreeScene::~EmbreeScene() {
  const std::lock_guard lock(build_mutex());
  rtcReleaseScene(scene_);
}

std::optional<SceneHit> EmbreeScene::nearest(const Ray& ray, RayKind kind, float t_min) const {
  return meet_nearest(scene_, to_embree(ray, kind, t_min));
}

std::optional<SceneHit> meet_nearest(RTCScene scene, const RTCRay& ray) {
  RTCRayHit query;
  query.ray = ray;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace_nearest(scene, query);
  const RTCHit& met = query.hit;
  if (met.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  SceneHit hit;
  hit.number = met.instID[0] == RTC_INVALID_GEOMETRY_ID ? met.geomID : met.instID[0];
  hit.inner = met.geomID;
  hit.primitive = met.primID;
  hit.copy = std::bit_cast<uint32_t>(met.Ng_x);
  hit.copied = std::bit_cast<uint32_t>(met.Ng_y);
  hit.t = static_cast<double>(query.ray.tfar);
  return hit;
}

bool EmbreeScene::occluded(const Ray& ray) const {
  RTCRay query = to_embree(ray, RayKind::occlusion, kNearest);
  trace_any(scene_, query);
  return query.tfar < 0.0F;
}

EmbreeBuilder::EmbreeBuilder() : lock_(build_mutex()) {
  const Result<RTCDevice> found = embree_device();
  if (!found) {
    status_ = found.error();
    return;
  }
  device_ = *found;
  before_ = embree_memory();
  rtcGetDeviceError(device_);  // forget what another build left
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, kBuildQuality);
  rtcSetSceneFlags(scene_, kSceneFlags);
}

EmbreeBuilder::~EmbreeBuilder() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
}

void EmbreeBuilder::attach(RTCGeometry geometry, unsigned id) {
  rtcSetGeometryBuildQuality(geometry, kBuildQuality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

void EmbreeBuilder::add_mesh(const MeshBuffers& buffers, unsigned mask, uint32_t number) {
  attach(new_mesh_geometry(device_, buffers, mask), number);
}

void EmbreeBuilder::add_curves(const CurveSet& curves, unsigned mask, uint32_t number) {
  attach(new_curve_geometry(device_, curves, mask), number);
}

void EmbreeBuilder::add_quadric(const PlacedObject& object, unsigned mask, uint32_t number) {
  attach(new_quadric_geometry(device_, object, mask), number);
}

void EmbreeBuilder::add_instance(const RayScene& scene, const PlacedObject& object, unsigned mask,
                                 uint32_t number) {
  attach(new_instance_geometry(device_, handle_of(scene), object.motion(), mask), number);
}

void EmbreeBuilder::add_scene(const RayScene& scene, uint32_t number) {
  attach(new_instance_geometry(device_, handle_of(scene), Motion(), kAllRays), number);
}

void EmbreeBuilder::add_copies(const InstancerScene& copies) {
  attach(new_copies_geometry(device_, copies), 0);
}

Result<std::shared_ptr<const RayScene>> EmbreeBuilder::commit() {
  if (!status_) return status_.error();
  const FpMode mode;
  rtcCommitScene(scene_);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE) {
    return Error{"Embree cannot build the scene: " + name_of(error)};
  }
  std::shared_ptr<EmbreeScene> done(new EmbreeScene);
  done->scene_ = std::exchange(scene_, nullptr);
  done->memory_ = embree_memory() - before_;
  lock_.unlock();
  return std::shared_ptr<const RayScene>(std::move(done));
}

}  // namespace hyades::core
