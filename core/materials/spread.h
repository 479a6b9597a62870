#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// How widely a BSDF scatters, for layers on top of it: mean reflectances and transmittances (of
/// sheets, which leave light on the other side as they reflect it) of what goes anywhere, and of
/// what GGX facets of width alpha do. What mirrors do is left out: layers weigh it exactly.
struct Spread {
  Rgb wide{0.0F};
  Rgb lobe{0.0F};
  Rgb wide_through{0.0F};
  Rgb lobe_through{0.0F};
  float alpha = 0.0F;

  Rgb back() const { return wide + lobe; }
  Rgb through() const { return wide_through + lobe_through; }

  /// Adds `share` of `other`; facets of both are then of a width between.
  void add(const Spread& other, const Rgb& share) {
    const float before = max_component(lobe + lobe_through);
    const float more = max_component(share * (other.lobe + other.lobe_through));
    if (before + more > 0.0F) alpha = (before * alpha + more * other.alpha) / (before + more);
    wide += share * other.wide;
    lobe += share * other.lobe;
    wide_through += share * other.wide_through;
    lobe_through += share * other.lobe_through;
  }

  bool operator==(const Spread&) const = default;
};

}  // namespace hyades::core
