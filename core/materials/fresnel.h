#pragma once

#include <cmath>

#include "core/base/vec.h"

/// What part of the light a smooth interface reflects. Unpolarised, exact (no Schlick).
namespace hyades::core {

/// x^5: how Schlick's formula falls off from grazing angles (Schlick 1994, eq. 15).
inline float fifth_power(float x) { return x * x * x * x * x; }

/// A refracted direction, or total internal reflection.
struct DielectricInterface {
  float reflectance = 1.0F;  ///< 1 where all is reflected
  float cos_t = 0.0F;        ///< cosine of the refracted direction, >= 0
};

/// Fresnel's equations for a dielectric (Born and Wolf 1999, section 1.5.2). `cos_i` in [0, 1] on
/// the side where light arrives; `eta` > 0: index of the other side over that of the arriving side.
inline DielectricInterface fresnel_dielectric(float cos_i, float eta) {
  // (eta cos_t)^2, in a form that leaves cos_i as it is where eta is 1.
  const float inner = (eta - 1.0F) * (eta + 1.0F) + cos_i * cos_i;
  if (!(inner > 0.0F)) return {};
  const float eta_cos_t = std::sqrt(inner);
  const float r_s = (cos_i - eta_cos_t) / (cos_i + eta_cos_t);
  const float eta2_cos_i = eta * eta * cos_i;
  const float r_p = (eta2_cos_i - eta_cos_t) / (eta2_cos_i + eta_cos_t);
  return {0.5F * (r_p * r_p + r_s * r_s), eta_cos_t / eta};
}

/// Fresnel's equations for light that arrives from vacuum on a metal of index eta + i k, at cosine
/// `cos_i` in [0, 1] (Born and Wolf 1999, section 14.2, in real arithmetic). eta, k >= 0.
inline float fresnel_conductor(float cos_i, float eta, float k) {
  const float cos2 = cos_i * cos_i;
  const float sin2 = 1.0F - cos2;
  // (a + i b)^2 = (eta + i k)^2 - sin^2; a is found without cancellation where k is large.
  const float re = (eta - k) * (eta + k) - sin2;
  const float im = 2.0F * eta * k;
  const float modulus = std::sqrt(re * re + im * im);
  const float twice_a2 = re >= 0.0F ? modulus + re : im * im / (modulus - re);
  const float twice_a_cos = 2.0F * std::sqrt(0.5F * twice_a2) * cos_i;
  const float s = modulus + cos2;
  if (!(s + twice_a_cos > 0.0F)) return 1.0F;
  const float r_s = (s - twice_a_cos) / (s + twice_a_cos);
  const float p = cos2 * modulus + sin2 * sin2;
  const float q = twice_a_cos * sin2;
  if (!(p + q > 0.0F)) return r_s;
  return 0.5F * r_s * (1.0F + (p - q) / (p + q));
}

inline Rgb fresnel_conductor(float cos_i, const Rgb& eta, const Rgb& k) {
  return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
          fresnel_conductor(cos_i, eta.z, k.z)};
}

}  // namespace hyades::core
