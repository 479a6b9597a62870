#pragma once

namespace hyades::core {

/// Weight of a sample drawn with density `pdf` where another technique would draw it with `other`:
/// power heuristic with exponent 2 (Veach 1997, eq. 9.10). 1 where `other` is 0.
inline float power_heuristic(float pdf, float other) {
  if (!(pdf > 0.0F)) return 0.0F;
  const float ratio = other / pdf;  // squares of the densities themselves could overflow
  return 1.0F / (1.0F + ratio * ratio);
}

}  // namespace hyades::core
