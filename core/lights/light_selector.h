#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/lights/make_light.h"

namespace hyades::core {

struct SelectedLight {
  uint32_t index = 0;
  float probability = 0.0F;
};

/// Chooses one light among many. The interface takes the reference point so that a light tree can
/// stand behind it later. Probabilities sum to 1 over the lights for every reference point.
class LightSelector {
 public:
  virtual ~LightSelector() = default;

  /// A light for the point `from` with normal `normal` (zero: none, in a medium); nothing where no
  /// light has power.
  virtual std::optional<SelectedLight> select(const Vec3& from, const Vec3& normal,
                                              float u) const = 0;

  /// The probability with which select returns `light`.
  virtual float probability(const Vec3& from, const Vec3& normal, uint32_t light) const = 0;

  /// A light for a light path to begin at; nothing where no light has power.
  virtual std::optional<SelectedLight> select_emitter(float u) const = 0;

  /// The probability with which select_emitter returns `light`.
  virtual float emitter_probability(uint32_t light) const = 0;
};

/// Finite lights in proportion to their power, infinite ones likewise, and either kind half of the
/// time where both are there: the power of a sky grows with the world's size (a wide ground would
/// starve the lamps), so the two kinds' powers cannot be compared. Lights of zero power are never
/// chosen.
std::unique_ptr<LightSelector> make_power_selector(const std::vector<LightPtr>& lights);

}  // namespace hyades::core
