#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/materials/spread.h"

namespace hyades::core {

/// What travels along the path being built. Where the adjoint differs (refraction scales radiance
/// by the squared ratio of indices, importance not) it decides; never defaulted.
enum class TransportMode { radiance, importance };

/// Whether what is carried in `mode` changes by 1 / eta^2 where it is refracted into another
/// index: radiance does; where `scale_radiance` is off, what has to change in its stead so that
/// paths from both ends agree is importance.
inline bool is_scaled(TransportMode mode, bool scale_radiance) {
  return (mode == TransportMode::radiance) == scale_radiance;
}

struct BsdfSample {
  Rgb weight{0.0F};            ///< f |cos theta_i| / pdf
  float pdf = 0.0F;            ///< per solid angle; of a delta lobe: its discrete probability
  Vec3 wi{0.0F, 0.0F, 1.0F};   ///< local, unit
  bool delta = false;          ///< from a delta lobe: evaluate() and pdf() know nothing of it
  bool transmitted = false;    ///< wi is on the other side of the surface than wo
  float eta = 1.0F;            ///< index of the side of wi over that of wo (1 unless refracted)
  bool scale_radiance = true;  ///< see is_scaled()
};

/// What light does at a surface point. Local coordinates: z is the shading normal on the shape's
/// outer side; wo points towards where the path came from, wi towards where it goes on; both unit
/// and both away from the surface; either may lie below (z < 0) on two-sided and transmitting
/// surfaces. Immutable.
class Bsdf {
 public:
  virtual ~Bsdf() = default;

  /// f(wo, wi) |cos theta_i|, delta lobes excluded.
  virtual Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const = 0;

  /// The part of evaluate() that is diffuse reflection, for the layers that tell diffuse from
  /// glossy light: in every channel from 0 to evaluate(), 0 where wo and wi lie on different sides,
  /// and the same share of it in both modes. What else is reflected counts as glossy.
  virtual Rgb evaluate_diffuse(const Vec3& /*wo*/, const Vec3& /*wi*/) const { return Rgb(0.0F); }

  /// Density of sample() returning wi, per solid angle, delta lobes excluded.
  virtual float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const = 0;

  /// Picks wi. `lobe` chooses among lobes, `u` within one; all in [0, 1). Nothing: absorbed.
  virtual std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                           TransportMode mode) const = 0;

  /// Directional reflectance plus transmittance, approximate, for the albedo layer and for guiding
  /// choices.
  virtual Rgb albedo(const Vec3& wo) const = 0;

  /// How widely it scatters light from the side z > 0 or z < 0 (`side` 1 or -1). None: as a mirror.
  virtual Spread spread(float /*side*/) const { return {}; }

  /// Whether evaluate() can be anything but 0 (else next-event estimation is pointless).
  virtual bool has_smooth() const { return true; }

  /// Whether light passes as if nothing were there (null material): no scattering event.
  virtual bool is_null() const { return false; }
};

/// Memory for the BSDFs of one surface point, or of all of a path: no destructors, and no
/// allocation once it has been as full as it gets. A BSDF lives until reset().
class BsdfArena {
 public:
  void reset() {
    block_ = 0;
    used_ = 0;
  }

  template <class T, class... Args>
  const T* make(Args&&... args) {
    static_assert(sizeof(T) <= kSize && alignof(T) <= kAlignment);
    size_t begin = (used_ + alignof(T) - 1) / alignof(T) * alignof(T);
    if (begin + sizeof(T) > kSize) {
      ++block_;
      begin = 0;
    }
    if (block_ == blocks_.size()) blocks_.push_back(std::make_unique<Block>());
    used_ = begin + sizeof(T);
    return ::new (blocks_[block_]->memory + begin) T(std::forward<Args>(args)...);
  }

 private:
  static constexpr size_t kSize = 4096;
  static constexpr size_t kAlignment = 16;
  struct Block {
    alignas(kAlignment) std::byte memory[kSize];
  };

  std::vector<std::unique_ptr<Block>> blocks_;
  size_t block_ = 0;  ///< the one that is being filled
  size_t used_ = 0;   ///< of it, bytes
};

}  // namespace hyades::core
