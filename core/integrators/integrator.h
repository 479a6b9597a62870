#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/job/job.h"
#include "core/materials/bsdf.h"
#include "core/samplers/sampler.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// What one sample of a pixel yields.
struct PixelSample {
  Rgb radiance{0.0F};
  float alpha = 0.0F;       ///< 1 where the camera ray met a surface
  float depth = kInfinity;  ///< along the view axis, of the first surface
  Rgb albedo{0.0F};   ///< of the first surface that is not a mirror, through the mirrors before it
  Vec3 normal{0.0F};  ///< shading normal of the first surface
  static constexpr uint32_t kNoObject = ~0U;
  uint32_t object = kNoObject;  ///< which placement the first surface belongs to
  uint32_t primitive = 0;       ///< its triangle
  Vec3 position{0.0F};          ///< of the first surface, world space
};

/// What a light path brings to the film, wherever it ends.
struct Splat {
  Vec2 film{0.0F};  ///< place in pixels of the full frame, y down; pixel centres are at .5
  /// An estimate of a pixel's value is the filter around its centre, at `film`, times this: as
  /// radiance is, but for all pixels.
  Rgb value{0.0F};
  uint32_t first_part = 0;  ///< its parts, where light is told apart: in LightParts::splat_parts()
  uint32_t parts = 0;
};

/// A path in words, for `hyades replay`.
struct PathLog {
  std::vector<std::string> lines;
};

/// What an integrator keeps from one sample to the next to save work; no result depends on it.
struct IntegratorScratch {
  virtual ~IntegratorScratch() = default;
};

class LightParts;
class PathWatcher;

/// Scratch memory and counters of one rendering thread, for one integrator.
struct Workspace {
  BsdfArena arena;
  /// Of the sample that is being taken: integrators append, the renderer takes them away.
  std::vector<Splat> splats;
  std::unique_ptr<IntegratorScratch> scratch;  ///< made by the integrator when it is first needed
  uint64_t rays = 0;                           ///< closest-hit and occlusion queries
  uint64_t bounces = 0;                        ///< scattering events
  LightParts* parts = nullptr;                 ///< tells light apart; null: nobody asks
  PathLog* log = nullptr;                      ///< where to tell the path; null while rendering
  PathWatcher* watcher = nullptr;  ///< told of what bdpt finds (found_path.h); null while rendering
};

/// How paths are found and weighed. Immutable and thread-safe. Integrators that work sample by
/// sample and pixel by pixel implement this; the sampler's dimensions before kCameraDimensions
/// belong to the camera.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// The radiance that arrives along `ray`, an unbiased estimate. `sampler` has been started for
  /// this sample.
  virtual PixelSample sample(const Scene& scene, const Ray& ray, Sampler& sampler,
                             Workspace& work) const = 0;
};

/// Film position (2), lens (2), time (1), and up to the next group of the Sobol sampler.
inline constexpr uint32_t kCameraDimensions = 8;

/// The integrator that `desc.type` names; of mlt what is found sample by sample: light that the
/// camera meets directly, and the layers (metropolis.h has the rest).
std::unique_ptr<Integrator> make_integrator(const IntegratorDesc& desc);

/// The names that make_integrator knows.
std::vector<std::string> integrator_names();

}  // namespace hyades::core
