#include "core/geometry/embree.h"

#include <atomic>
#include <utility>

#include "core/base/fp_mode.h"
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

/// Held while a scene is built or released, so that a change of held_bytes belongs to one scene.
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

SceneBuilder::SceneBuilder() : lock_(build_mutex()) {
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

SceneBuilder::~SceneBuilder() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
}

void SceneBuilder::attach(RTCGeometry geometry, unsigned id) {
  rtcSetGeometryBuildQuality(geometry, kBuildQuality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

Result<std::shared_ptr<const EmbreeScene>> SceneBuilder::commit() {
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
  return std::shared_ptr<const EmbreeScene>(std::move(done));
}

}  // namespace hyades::core
