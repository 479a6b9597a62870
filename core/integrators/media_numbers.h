#pragma once

#include <cstdint>

#include "core/samplers/sampler.h"

namespace hyades::core {

/// Surfaces that a ray may pass without scattering (null materials) before it counts as caught in a
/// bad mesh.
inline constexpr int kMaxNullCrossings = 1000;

/// The random numbers that media and surfaces with an opacity ask for, in dimensions that nothing
/// else uses: what surfaces draw does not depend on whether there are such things. Each way between
/// two events of a path has a run of groups of its own, so that the first way from the camera is
/// well stratified in every pixel.
class MediaNumbers {
 public:
  enum class Purpose : uint32_t {
    flight,
    shadow,
    light_flight,
    connection,
    passing,       ///< of a way from the camera through surfaces that are not all there
    light_passing  ///< of one from a light
  };

  /// The numbers of the way after `depth` scattering events; of connections `depth` is their
  /// number, modulo 2^16 (two that share numbers are different terms of a sum).
  MediaNumbers(Sampler& sampler, int depth, Purpose purpose)
      : sampler_(&sampler),
        dimension_(first(purpose) + (static_cast<uint32_t>(depth) % kWays) * 2 * kPerWay) {}

  /// For the next surface on the way: one number alone.
  float next_number() {
    sampler_->set_dimension(dimension_);
    dimension_ += 4;
    return sampler_->next_1d();
  }

  /// For which kind of ray goes on from the event at the way's end.
  float kind_number() {
    sampler_->set_dimension(dimension_ + kPerWay - 4);
    return sampler_->next_1d();
  }

  /// For the next part of the way.
  Vec4 next() {
    sampler_->set_dimension(dimension_);
    dimension_ += 4;
    return sampler_->next_4d();
  }

 private:
  static constexpr uint32_t kFirst = 1U << 20U;   ///< above all that 65,536 bounces draw
  static constexpr uint32_t kSecond = 1U << 31U;  ///< of light paths and connections
  static constexpr uint32_t kThird = 3U << 30U;   ///< of passing: up to the last dimension of all
  static constexpr uint32_t kPerWay = 1U << 13U;  ///< kMaxNullCrossings + 1 parts of twice four
  static constexpr uint32_t kWays = 1U << 16U;

  static constexpr uint32_t first(Purpose purpose) {
    const auto p = static_cast<uint32_t>(purpose);
    return (p < 2 ? kFirst : (p < 4 ? kSecond : kThird)) + p % 2 * kPerWay;
  }

  Sampler* sampler_;
  uint32_t dimension_;
};
static_assert(8 * (kMaxNullCrossings + 1) < 1 << 13);

}  // namespace hyades::core
