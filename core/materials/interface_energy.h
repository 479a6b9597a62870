#pragma once

#include <array>

#include "core/base/vec.h"

namespace hyades::core {

/// What GGX facets of a dielectric of one relative index reflect by single scattering:
/// R(cos theta_o, alpha), what is transmitted left out. Tabulated by quadrature (10 ms) within
/// 0.002.
class InterfaceTable {
 public:
  /// `eta` >= 0: index of the other side over that of the side where light arrives.
  explicit InterfaceTable(float eta);

  float reflected(float cosine, float alpha) const;

  /// The mean over the hemisphere of 1 - R, weighed with the cosine.
  float mean_rest(float alpha) const;

 private:
  static constexpr int kCosines = 56;  ///< even in the root of the cosine
  static constexpr int kRows = 44;     ///< even in roughness

  std::array<std::array<float, kCosines>, kRows> reflected_;
  std::array<float, kRows> mean_rest_;
};

/// What InterfaceTable tells for any index, interpolated between tables that are made at first use.
/// Cheap to make.
class InterfaceEnergy {
 public:
  explicit InterfaceEnergy(float eta);

  float reflected(float cosine, float alpha) const {
    const float low = low_->reflected(cosine, alpha);
    return low + part_ * (high_->reflected(cosine, alpha) - low);
  }

  float mean_rest(float alpha) const {
    const float low = low_->mean_rest(alpha);
    return low + part_ * (high_->mean_rest(alpha) - low);
  }

 private:
  const InterfaceTable* low_;
  const InterfaceTable* high_;
  float part_;
};

}  // namespace hyades::core
