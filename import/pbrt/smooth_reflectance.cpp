#include "import/pbrt/smooth_reflectance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hyades::core::pbrt {
namespace {

constexpr double kFirst = 380.0;
constexpr double kLast = 780.0;
constexpr int kSamples = 81;
constexpr int kStages = 10;
constexpr int kSteps = 12;
constexpr double kMostCoefficient = 2000.0;

double wavelength(int i) { return kFirst + (kLast - kFirst) * i / (kSamples - 1); }

double reflectance(const Vec3d& c, double w) {
  const double t = (w - kFirst) / (kLast - kFirst);
  const double x = (c.x * t + c.y) * t + c.z;
  return 0.5 + 0.5 * x / std::sqrt(1.0 + x * x);
}

Spectrum spectrum_of(const Vec3d& c) {
  Spectrum out;
  for (int i = 0; i < kSamples; ++i) {
    out.wavelengths.push_back(wavelength(i));
    out.values.push_back(reflectance(c, wavelength(i)));
  }
  return out;
}

/// What a sample counts in each channel; their sums over all samples are 1.
std::vector<Vec3d> channel_weights() {
  std::vector<Vec3d> weights;
  Vec3d sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    weights.push_back(surface_weight(wavelength(i)));
    sum += weights.back();
  }
  for (Vec3d& weight : weights) weight /= sum;
  return weights;
}

Vec3d color_of(const Vec3d& c, const std::vector<Vec3d>& weights) {
  Vec3d sum(0.0);
  for (int i = 0; i < kSamples; ++i) {
    sum += weights[static_cast<size_t>(i)] * reflectance(c, wavelength(i));
  }
  return sum;
}

/// A step of Gauss and Newton, damped by Marquardt's rule, and never uphill.
Vec3d nearer(const Vec3d& c, const Vec3d& target, const std::vector<Vec3d>& weights) {
  const Vec3d error = target - color_of(c, weights);
  if (glm::dot(error, error) < 1e-14) return c;
  glm::dmat3 slope;
  for (int i = 0; i < 3; ++i) {
    Vec3d moved = c;
    const double step = 1e-5 * std::max(1.0, std::fabs(c[i]));
    moved[i] += step;
    slope[i] = (color_of(moved, weights) - color_of(c, weights)) / step;
  }
  const glm::dmat3 squared = glm::transpose(slope) * slope;
  for (double damping = 1e-9; damping < 1e3; damping *= 10.0) {
    glm::dmat3 damped = squared;
    for (int i = 0; i < 3; ++i) damped[i][i] += damping * std::max(squared[i][i], 1e-12);
    const Vec3d next = c + glm::inverse(damped) * (glm::transpose(slope) * error);
    if (!(glm::dot(next, next) < kMostCoefficient * kMostCoefficient)) continue;
    const Vec3d rest = target - color_of(next, weights);
    if (glm::dot(rest, rest) < glm::dot(error, error)) return next;
  }
  return c;
}

}  // namespace

Spectrum smooth_reflectance(const Rgb& color) {
  static const std::vector<Vec3d> weights = channel_weights();
  const Vec3d wanted = glm::clamp(Vec3d(color), Vec3d(0.0), Vec3d(1.0));
  const double grey = std::clamp((wanted.x + wanted.y + wanted.z) / 3.0, 1e-4, 1.0 - 1e-4);
  // A sigmoid of a constant is grey; from there on little by little.
  const double odds = 2.0 * grey - 1.0;
  Vec3d c(0.0, 0.0, odds / std::sqrt(1.0 - odds * odds));
  if (wanted.x == wanted.y && wanted.y == wanted.z) return spectrum_of(c);
  for (int stage = 1; stage <= kStages; ++stage) {
    const Vec3d target = glm::mix(Vec3d(grey), wanted, static_cast<double>(stage) / kStages);
    for (int step = 0; step < kSteps; ++step) {
      const Vec3d next = nearer(c, target, weights);
      if (next == c) break;
      c = next;
    }
  }
  return spectrum_of(c);
}

}  // namespace hyades::core::pbrt
