#pragma once

#include "core/integrators/integrator.h"
#include "core/integrators/media_numbers.h"
#include "core/integrators/path_vertex.h"

namespace hyades::core {

/// The way on from the last vertex of a subpath.
struct Way {
  Ray ray;
  Rgb throughput{1.0F};   ///< what arrives at the end of the way, before media take their part
  double pdf = 1.0;       ///< density per solid angle of its direction; of delta lobes 1
  bool specular = false;  ///< a delta lobe chose it: nothing else could have
  MediumStack around;     ///< the bodies that it begins in
  /// Parallel rays, of light from infinitely far away or of a camera: their density per area across
  /// them; else 0.
  double pdf_across = 0.0;

  /// The density in `v`'s own measure with which this way, from a vertex at `from`, leads to it.
  double density_at(const PathVertex& v, const Vec3& from) const;
};

/// What a walk meets besides vertices.
class WalkWatcher {
 public:
  virtual ~WalkWatcher() = default;

  /// The medium on the way gives off `radiance`; `way.throughput` is what of it arrives.
  virtual void medium_emits(const Way& /*way*/, const Rgb& /*radiance*/) {}

  /// A surface, before it becomes a vertex or is crossed (null surfaces).
  virtual void meets(const Way& /*way*/, const SurfacePoint& /*point*/,
                     const SceneObject& /*object*/) {}

  /// The way leaves the scene.
  virtual void leaves(const Way& /*way*/) {}

  /// A vertex was added; the walk has not gone on from it.
  virtual void arrives(const PathVertex& /*vertex*/) {}

  /// The walk goes on from its last vertex along `way`.
  virtual void goes_on(const PathVertex& /*from*/, const Way& /*way*/) {}
};

/// Where a walk takes its random numbers from.
struct WalkNumbers {
  uint32_t first = 0;      ///< dimension of the first scattering event
  uint32_t per_event = 4;  ///< distance to the next event's
  MediaNumbers::Purpose flights = MediaNumbers::Purpose::flight;
  MediaNumbers::Purpose passing = MediaNumbers::Purpose::passing;
};

/// Lengthens subpaths by scattering: the random walk of path tracing, from the camera
/// (TransportMode::radiance) or from a light (importance), which keeps its vertices and what their
/// weights need.
class RandomWalk {
 public:
  RandomWalk(const IntegratorDesc& settings, const Scene& scene, Sampler& sampler, Workspace& work,
             TransportMode mode, const WalkNumbers& numbers)
      : settings_(settings),
        scene_(scene),
        sampler_(sampler),
        work_(work),
        mode_(mode),
        numbers_(numbers) {}

  /// Goes on along `way` until `path`, which has its first vertex, has `most` vertices, the walk
  /// leaves the scene, or roulette ends it.
  void go(Subpath& path, Way way, int most, WalkWatcher& watcher);

 private:
  PathVertex* next_vertex(Subpath& path, Way& way, WalkWatcher& watcher);
  void connect_to_last(Subpath& path, const Way& way, PathVertex& v) const;
  bool scatter(Subpath& path, Way& way);
  bool survives(Way& way, float u);

  const IntegratorDesc& settings_;
  const Scene& scene_;
  Sampler& sampler_;
  Workspace& work_;
  TransportMode mode_;
  WalkNumbers numbers_;
  int events_ = 0;
  float eta_scale_ = 1.0F;
  float start_ = 1.0F;  ///< the walk's first throughput, which roulette compares with
};

}  // namespace hyades::core
