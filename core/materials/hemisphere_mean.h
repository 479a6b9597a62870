#pragma once

#include <array>
#include <cstddef>

#include "core/base/vec.h"

namespace hyades::core {

/// The mean of f(cosine) over the hemisphere, weighed with the cosine: 2 integral of f(mu) mu dmu,
/// by Gauss and Legendre's rule of six points in the root of the cosine. Within 0.002 of what
/// smooth interfaces reflect.
template <class F>
auto hemisphere_mean(const F& f) {
  constexpr std::array<float, 6> kNodes = {0.033765243F, 0.169395307F, 0.380690407F,
                                           0.619309593F, 0.830604693F, 0.966234757F};
  constexpr std::array<float, 6> kWeights = {0.085662246F, 0.180380787F, 0.233956967F,
                                             0.233956967F, 0.180380787F, 0.085662246F};
  auto sum = f(0.0F) * 0.0F;
  for (size_t n = 0; n < kNodes.size(); ++n) {
    const float x = kNodes[n];
    sum += f(x * x) * (kWeights[n] * 4.0F * x * x * x);
  }
  return sum;
}

}  // namespace hyades::core
