#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/lights/make_light.h"

namespace hyades::core {

/// Bits of lists of objects that lights are linked to: a light of list i lights what has bit i.
using ListBits = uint64_t;
inline constexpr ListBits kAllLists = ~ListBits{0};

/// Whether what is in `lists` is in list `number`.
constexpr bool is_in(ListBits lists, uint8_t number) { return (lists >> number & 1U) != 0; }

struct SelectedLight {
  uint32_t index = 0;
  float probability = 0.0F;
};

/// Chooses one light among many. For each way of asking probabilities sum to 1 over the lights, and
/// are exactly those with which lights come where `u` is a multiple of 2^-24. Lights that send no
/// light to where it is asked for, or are not linked to what is in `lists` there, may have
/// probability 0.
class LightSelector {
 public:
  virtual ~LightSelector() = default;

  /// Whether no light has power: then none is ever chosen.
  virtual bool empty() const = 0;

  /// A light for the point `from` with normal `normal` (zero: none, in a medium); nothing where no
  /// light has power.
  virtual std::optional<SelectedLight> select(const Vec3& from, const Vec3& normal, float u,
                                              ListBits lists = kAllLists) const = 0;

  /// The probability with which select returns `light`.
  virtual float probability(const Vec3& from, const Vec3& normal, uint32_t light,
                            ListBits lists = kAllLists) const = 0;

  /// A light whose light may be scattered anywhere on the way of `length` along `way`, in a medium.
  virtual std::optional<SelectedLight> select_along(const Ray& way, float length, float u,
                                                    ListBits lists = kAllLists) const = 0;

  /// The probability with which select_along returns `light`.
  virtual float probability_along(const Ray& way, float length, uint32_t light,
                                  ListBits lists = kAllLists) const = 0;

  /// A light for a light path to begin at; nothing where no light has power.
  virtual std::optional<SelectedLight> select_emitter(float u) const = 0;

  /// The probability with which select_emitter returns `light`.
  virtual float emitter_probability(uint32_t light) const = 0;
};

/// Finite lights in proportion to their power, infinite ones likewise, and either kind half of the
/// time where both are there: the power of a sky grows with the world's size (a wide ground would
/// starve the lamps), so the two kinds' powers cannot be compared. Lights of zero power are never
/// chosen. Whoever asks gets the same.
std::unique_ptr<LightSelector> make_power_selector(const std::vector<LightPtr>& lights);

/// Finite lights by a tree over them (core/lights/light_tree.h): near, bright and turned towards
/// the point ones come more often. Infinite ones in proportion to their power, and either kind a
/// quarter to three quarters of the time, by what both may bring; along ways half of the time, and
/// light paths begin as the power selector has it. `receivers`: the list that each is linked to;
/// empty: all to list 0, that of all objects. At most 2^23 lights.
std::unique_ptr<LightSelector> make_tree_selector(const std::vector<LightPtr>& lights,
                                                  const std::vector<uint8_t>& receivers = {});

}  // namespace hyades::core
