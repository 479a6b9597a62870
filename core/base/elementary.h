#pragma once

/// Elementary functions with the same bits on every processor and C library: polynomials in double
/// from + - * / sqrt alone, rounded once to float (glibc chooses FMA variants at run time, so its
/// sin, cos, exp, pow differ between machines; see docs/architecture.md). All accept any float;
/// errors are at most 0.51 ulp of float unless noted; NaN in gives NaN out.
namespace hyades::core {

struct SinCos {
  float sin;
  float cos;
};

SinCos sin_cos(float x);  ///< x in radians, any finite |x| <= 1e6 to full precision
float sin(float x);
float cos(float x);
float tan(float x);
float asin(float x);            ///< x clamped to [-1, 1]; radians
float acos(float x);            ///< x clamped to [-1, 1]; radians
float atan2(float y, float x);  ///< (-pi, pi]; atan2(0, 0) = 0
float exp(float x);             ///< overflows to +inf, underflows to 0
float expm1(float x);           ///< exp(x) - 1 without cancellation near 0
float log(float x);             ///< natural; log(0) = -inf, negative: NaN
float log1p(float x);
float exp2(float x);
float log2(float x);
float pow(float x, float y);  ///< x >= 0; pow(0, 0) = 1; negative x: NaN
float cbrt(float x);

}  // namespace hyades::core
