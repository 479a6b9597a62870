#pragma once

namespace hyades::core {

/// Weight of a sample drawn with density `pdf` where another technique would draw it with `other`:
/// power heuristic with exponent 2 (Veach 1997, eq. 9.10). 1 where `other` is 0.
inline float power_heuristic(float pdf, float other) {
  const float a = pdf * pdf;
  const float b = other * other;
  if (a + b == 0.0F) return 0.0F;
  return a > 1e37F ? 1.0F : a / (a + b);
}

}  // namespace hyades::core
