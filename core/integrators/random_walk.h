#pragma once

#include <cstdint>
#include <optional>

#include "core/integrators/integrator.h"
#include "core/integrators/media_numbers.h"
#include "core/integrators/medium_segment.h"
#include "core/materials/shaded_surface.h"

namespace hyades::core {

/// The part of a path that leads on from its last vertex.
struct PathSegment {
  Ray ray;
  Rgb throughput{1.0F};            ///< what arrives at its end, before media take their part
  double pdf = 1.0;                ///< density per solid angle of its direction; of delta lobes 1
  bool specular = false;           ///< a delta lobe chose it: nothing else could have
  MediumStack around;              ///< the bodies that it begins in
  RayKind kind = RayKind::camera;  ///< of its ray; where all scattered ones see the same, diffuse
  /// Parallel rays, of light from infinitely far away or of a camera: their density per area across
  /// them; else 0.
  double pdf_across = 0.0;
};

/// A place where a walk may scatter.
struct ScatteringPlace {
  const SceneObject* object = nullptr;  ///< whose surface; null: in a medium
  SurfacePoint point;                   ///< on a surface
  MediumSegment flight;                 ///< in a medium: on which the walk came there
  float t = 0.0F;                       ///< how far along it
  Vec3 position{0.0F};
};

/// What a walk meets besides places where it may scatter.
class WalkWatcher {
 public:
  virtual ~WalkWatcher() = default;

  /// The medium along `segment` gives off `radiance`; the segment's throughput is what of it
  /// arrives.
  virtual void medium_emits(const PathSegment& /*segment*/, const Rgb& /*radiance*/) {}

  /// The walk looks for a place to scatter along `flight`, which ends at `surface` (null: nowhere).
  /// `numbers` are those of media along it.
  virtual void flies(const MediumSegment& /*flight*/, const SurfacePoint* /*surface*/,
                     MediaNumbers& /*numbers*/) {}

  /// A surface, before the walk may scatter there; `passed`: it goes straight through.
  virtual void meets(const PathSegment& /*segment*/, const SurfacePoint& /*point*/,
                     const SceneObject& /*object*/, bool /*passed*/) {}

  /// A holdout, where a walk from the camera ends.
  virtual void meets_holdout(const SceneObject& /*object*/) {}

  /// The segment leaves the scene.
  virtual void leaves(const PathSegment& /*segment*/) {}

  /// Russian roulette ends the walk.
  virtual void loses_roulette() {}
};

/// Which way light is followed, and where the walk takes its random numbers from.
struct WalkKind {
  TransportMode mode = TransportMode::radiance;  ///< from the camera; importance: from a light
  uint32_t first = 0;                            ///< dimension of the first scattering event
  uint32_t per_event = 4;                        ///< distance to the next event's
  MediaNumbers::Purpose flights = MediaNumbers::Purpose::flight;
  MediaNumbers::Purpose passing = MediaNumbers::Purpose::passing;
};

/// The random walk of all integrators: straight through null surfaces, free flight in media, and
/// scattering along BSDFs and phase functions until roulette ends it.
class RandomWalk {
 public:
  /// Begins along `start`. `watcher` outlives the walk.
  RandomWalk(const IntegratorDesc& settings, const Scene& scene, Sampler& sampler, Workspace& work,
             const WalkKind& kind, const PathSegment& start, WalkWatcher& watcher);

  /// Follows the segment to the next place where light may scatter; false where there is none.
  bool next(ScatteringPlace& place);

  /// Goes on from `surface` of `object` along its BSDF, away from `wo`: how, or nothing where the
  /// walk ends.
  std::optional<BsdfSample> scatter(const ShadedSurface& surface, const SceneObject& object,
                                    const Vec3& wo);

  /// Goes on from `position` along the phase function of `medium`; false where the walk ends.
  bool scatter(const Medium& medium, const Vec3& position);

  /// The segment that the walk is on. Its pdf is the walker's to change: the walk never reads it.
  PathSegment& segment() { return segment_; }
  const PathSegment& segment() const { return segment_; }

  TransportMode mode() const { return kind_.mode; }

  /// How often it has scattered.
  int events() const { return events_; }

 private:
  enum class Flight { passed, scattered, absorbed };

  Flight fly(const Medium& medium, const SurfacePoint* surface, MediaNumbers& numbers,
             ScatteringPlace& place, bool held_out);
  bool is_held_out(const Body* body) const;
  RayKind choose_kind(const ShadedSurface& surface, const Vec3& wo, const BsdfSample& sample);
  Vec4 event_numbers();
  bool survives(float u);

  const IntegratorDesc& settings_;
  const Scene& scene_;
  Sampler& sampler_;
  Workspace& work_;
  WalkKind kind_;
  WalkWatcher& watcher_;
  PathSegment segment_;
  float start_;  ///< the first throughput, which roulette compares with
  float eta_scale_ = 1.0F;
  int events_ = 0;
};

}  // namespace hyades::core
