#pragma once

#include <cstdint>
#include <optional>

#include "core/integrators/subpath_walk.h"

namespace hyades::core {

/// Dimensions of light paths: above those of the longest camera path, below those of media.
inline constexpr uint32_t kLightPathDimensions = (1U << 19U) + 64;
/// Of them, place on the light (2), which light, which part; direction (2), lens (2).
inline constexpr uint32_t kLightPathStart = 8;

struct LightPathStart {
  std::optional<PathSegment>
      segment;      ///< nothing where no light leaves; else `path` has its first vertex
  Vec2 lens{0.0F};  ///< random numbers for a place of the lens
};

/// Begins a light path at shutter time `time`: a light, a place on it, a direction. Lights that are
/// infinitely far away send parallel rays through a disc that covers the world.
LightPathStart begin_light_path(const Scene& scene, float time, Sampler& sampler, Subpath& path);

/// Densities that concern the place where a path meets a light, all in the measure of that place
/// but `towards`.
struct LightDensities {
  double chosen = 0.0;   ///< from the vertex before, as path tracing chooses lights
  double emitted = 0.0;  ///< as the beginning of a light path
  double towards = 0.0;  ///< of the vertex before, chosen by a light path from there
};

/// For light vertex `on`, met from `before` along unit `direction`.
LightDensities light_densities(const Scene& scene, const PathVertex& on, const PathVertex& before,
                               const Vec3& direction);

/// LightDensities::towards of `v` as seen along unit `direction` from it to `on`.
double emission_density(const Scene& scene, const Light& light, const PathVertex& on,
                        const PathVertex& v, const Vec3& direction);

/// Corrects the sums of the first vertex after the light: choosing the light from there has another
/// density than beginning at it. Where the light is not linked to what is there the path ends.
class FirstLightVertex final : public SubpathWatcher {
 public:
  FirstLightVertex(const Scene& scene, Subpath& path) : scene_(scene), path_(path) {}
  bool arrives(const PathVertex& vertex) override;

 private:
  const Scene& scene_;
  Subpath& path_;
};

}  // namespace hyades::core
