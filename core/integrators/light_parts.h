#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/film/layout.h"
#include "core/geometry/world.h"
#include "core/materials/shaded_surface.h"
#include "core/media/medium.h"

namespace hyades::core {

/// What light met first, seen from the camera, as far as LightComponent asks.
struct FirstEvent {
  enum class Kind : uint8_t { reflection, transmission, volume };
  Kind kind = Kind::volume;
  Rgb diffuse{0.0F};  ///< of reflection: which share of it is diffuse, by channel

  /// At a surface that light comes to along unit `wi` and leaves along `wo`, to the camera; both
  /// away from it. `specular`: by a delta lobe.
  static FirstEvent at(const ShadedSurface& surface, const Vec3& wo, const Vec3& wi, bool specular);

  /// Which share of the light comes by rays of `kinds`; from now on it is only that.
  Rgb keep(RayKind kinds);
};

/// Which light a contribution comes from.
struct LightSource {
  static constexpr uint32_t kMedium = ~0U;
  uint32_t index = kMedium;        ///< in Scene::lights; kMedium: a medium that glows
  bool infinitely_far = false;     ///< seen directly it is the environment
  const Medium* medium = nullptr;  ///< where index is kMedium

  static LightSource of(const Medium& glowing) { return {kMedium, false, &glowing}; }
};

/// Which parts of light a film holds.
struct PartTable {
  std::array<int, kLightComponents> components{};  ///< the part of each, or -1
  std::vector<int> lights;                         ///< the part of each light's group, or -1
  std::vector<std::pair<const Medium*, int>>
      media;         ///< the part of the group of those that have one
  int rest = -1;     ///< the part of what has no group
  size_t count = 0;  ///< how many parts there are
};

/// A part of a splat's value.
struct SplatPart {
  uint32_t part = 0;
  Rgb value{0.0F};
};

/// Tells the light of one sample apart: every contribution goes to a component and to the group of
/// its light, channel by channel, so that the sum of either is all of it.
class LightParts {
 public:
  explicit LightParts(const PartTable& table) : table_(table), sums_(table.count, Rgb(0.0F)) {}

  /// Before each sample.
  void clear();

  /// Adds `light` to the sample's own pixel. `events`: how often it was scattered; `first`: where
  /// it was last scattered on its way to the camera (not looked at where events is 0).
  void add(const FirstEvent& first, int events, const LightSource& source, const Rgb& light);

  /// Appends the parts of a splat to splat_parts().
  void add_splat(const FirstEvent& first, int events, const LightSource& source, const Rgb& light);

  const std::vector<Rgb>& sums() const { return sums_; }  ///< by part
  std::vector<SplatPart>& splat_parts() { return splat_parts_; }

 private:
  template <class Take>
  void split(const FirstEvent& first, int events, const LightSource& source, const Rgb& light,
             const Take& take) const;

  const PartTable& table_;
  std::vector<Rgb> sums_;
  std::vector<SplatPart> splat_parts_;
};

}  // namespace hyades::core
