#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/geometry/ray_scene.h"

/// What differs between Embree 3 (Debian 12) and 4 (Debian 13), and the one device of the process.
/// Only .cpp files of this room include this header.
namespace hyades::core {

/// The build quality of every acceleration structure: never LOW, which is not deterministic where
/// surfaces coincide. HIGH (spatial splits) traces no faster on scanned meshes and takes twice the
/// memory.
inline constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;

/// The flags of every scene. ROBUST: rays that aim at an edge or a vertex do not slip through.
inline constexpr RTCSceneFlags kSceneFlags = RTC_SCENE_FLAG_ROBUST;

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline void trace_nearest(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, nullptr); }
inline void trace_any(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, nullptr); }
#else
using EmbreeContext = RTCIntersectContext;
inline void trace_nearest(RTCScene scene, RTCRayHit& ray) {
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
inline void trace_any(RTCScene scene, RTCRay& ray) {
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

/// What `ray` meets first in the scene; of copies what new_copies_geometry() says.
std::optional<SceneHit> meet_nearest(RTCScene scene, const RTCRay& ray);

/// The device, made at the first call and never released. Embree is pinned to AVX2, or, on a
/// processor without it, to SSE 4.2 (other bits: another class of worker). The error says what
/// Embree lacks.
Result<RTCDevice> embree_device();

/// Bytes that Embree holds now, over all scenes.
size_t embree_memory();

/// Embree may hold at most `bytes`; builds beyond fail as if memory had run out. 0: no limit.
void limit_embree_memory(size_t bytes);

/// A scene of Embree's.
class EmbreeScene final : public RayScene {
 public:
  ~EmbreeScene() override;
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  std::optional<SceneHit> nearest(const Ray& ray, RayKind kind, float t_min) const override;
  bool occluded(const Ray& ray) const override;
  size_t memory() const override { return memory_; }

  RTCScene handle() const { return scene_; }

 private:
  friend class EmbreeBuilder;
  EmbreeScene() = default;
  RTCScene scene_ = nullptr;
  size_t memory_ = 0;
};

/// Fills a scene of Embree's. Scenes are built one at a time in the process (each with all
/// threads), so that the bytes counted are its own.
class EmbreeBuilder final : public SceneBuilder {
 public:
  EmbreeBuilder();
  ~EmbreeBuilder() override;
  EmbreeBuilder(const EmbreeBuilder&) = delete;
  EmbreeBuilder& operator=(const EmbreeBuilder&) = delete;

  void add_mesh(const MeshBuffers& buffers, unsigned mask, uint32_t number) override;
  void add_curves(const CurveSet& curves, unsigned mask, uint32_t number) override;
  void add_quadric(const PlacedObject& object, unsigned mask, uint32_t number) override;
  void add_instance(const RayScene& scene, const PlacedObject& object, unsigned mask,
                    uint32_t number) override;
  void add_scene(const RayScene& scene, uint32_t number) override;
  void add_copies(const InstancerScene& copies) override;
  Result<std::shared_ptr<const RayScene>> commit() override;

 private:
  /// Commits `geometry`, attaches it as number `id` and releases the hold on it.
  void attach(RTCGeometry geometry, unsigned id);

  std::unique_lock<std::mutex> lock_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  size_t before_ = 0;
  Status status_;
};

}  // namespace hyades::core
