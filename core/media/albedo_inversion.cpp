#include "core/media/albedo_inversion.h"

#include <algorithm>
#include <cmath>

#include "core/materials/fresnel.h"

namespace hyades::core {

float diffuse_reflectance(float albedo, float g) {
  const float s = std::sqrt((1.0F - albedo) / (1.0F - albedo * g));
  return (1.0F - s) * (1.0F - 0.139F * s) / (1.0F + 1.17F * s);
}

float albedo_of_reflectance(float reflectance, float g) {
  const double a = reflectance;
  const double root = std::sqrt(9.59217 + 41.6808 * a + 17.7126 * a * a);
  const double s = std::clamp(4.09712 + 4.20863 * a - root, 0.0, 1.0);
  return static_cast<float>((1.0 - s * s) / (1.0 - g * s * s));
}

DiffuseFresnel diffuse_fresnel(float eta) {
  constexpr int kSteps = 512;
  double outer = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // Even in cos^2, by which diffuse light arrives.
    const auto cos2 = static_cast<float>((i + 0.5) / kSteps);
    outer += fresnel_dielectric(std::sqrt(cos2), eta).reflectance;
  }
  outer /= kSteps;
  // What goes in one way goes out the other: the cone that is refracted is 1 / eta^2 of all.
  const double inner = 1.0 - (1.0 - outer) / (double{eta} * eta);
  return {static_cast<float>(outer), static_cast<float>(std::max(inner, 0.0))};
}

float reflectance_through(float reflectance, float inner) {
  return (1.0F - inner) * reflectance / (1.0F - inner * reflectance);
}

float reflectance_behind(float seen, float inner) { return seen / (1.0F - inner + inner * seen); }

ScatteringNumbers scattering_of(const BodyColor& body) {
  const float inner = diffuse_fresnel(body.index).inner;
  ScatteringNumbers numbers;
  for (int c = 0; c < 3; ++c) {
    const float albedo = albedo_of_reflectance(reflectance_behind(body.color[c], inner), body.g);
    const float extinction = 1.0F / (body.radius[c] * (1.0F - albedo * body.g));
    numbers.scattering[c] = albedo * extinction;
    numbers.absorption[c] = extinction - numbers.scattering[c];
  }
  return numbers;
}

}  // namespace hyades::core
