#include "core/finish/linear_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hyades::core {
namespace {

constexpr int kN = LinearFit::kUnknowns;

/// Variance of a feature, about, below which it is not trusted.
constexpr double kRidge = 1e-3;

/// Where the squares of colours stand among the terms.
constexpr int kSquares = LinearFit::kProducts + 3 * kN;

/// Place of row i, column j <= i, of a triangle.
constexpr size_t place(int i, int j) { return static_cast<size_t>(i * (i + 1) / 2 + j); }

}  // namespace

LinearFit::Terms LinearFit::terms(const GuidedPicture::Features& features, const Rgb& color) {
  std::array<float, kUnknowns> v{1.0F};
  for (size_t i = 0; i < features.size(); ++i) v[i + 1] = features[i];
  Terms out{};
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j <= i; ++j)
      out[place(i, j)] = v[static_cast<size_t>(i)] * v[static_cast<size_t>(j)];
    for (int c = 0; c < 3; ++c) {
      out[static_cast<size_t>(kProducts + 3 * i + c)] = v[static_cast<size_t>(i)] * color[c];
    }
  }
  for (int c = 0; c < 3; ++c) out[static_cast<size_t>(kSquares + c)] = color[c] * color[c];
  return out;
}

LinearFit LinearFit::solve(const Terms& sums) {
  LinearFit fit;
  const double total = sums[0];
  if (!(total > 0.0)) return fit;
  // Around the means, the slopes stand apart from the base and the ridge holds back slopes alone.
  std::array<double, kN> mean{};
  for (int i = 1; i < kN; ++i) mean[static_cast<size_t>(i)] = sums[place(i, 0)] / total;
  std::array<double, 3> color{};
  for (int c = 0; c < 3; ++c)
    color[static_cast<size_t>(c)] = sums[static_cast<size_t>(kProducts + c)] / total;

  // Cholesky's decomposition of the features' covariance.
  double l[kN][kN] = {};
  double slopes[kN][3] = {};
  for (int i = 1; i < kN; ++i) {
    const auto mi = mean[static_cast<size_t>(i)];
    for (int j = 1; j <= i; ++j) {
      double s = sums[place(i, j)] / total - mi * mean[static_cast<size_t>(j)];
      if (i == j) s += kRidge;
      for (int k = 1; k < j; ++k) s -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(std::max(s, kRidge * 1e-2)) : s / l[j][j];
    }
    for (int c = 0; c < 3; ++c) {
      double s = sums[static_cast<size_t>(kProducts + 3 * i + c)] / total -
                 mi * color[static_cast<size_t>(c)];
      for (int k = 1; k < i; ++k) s -= l[i][k] * slopes[k][c];
      slopes[i][c] = s / l[i][i];
    }
  }
  for (int c = 0; c < 3; ++c) {
    double base = color[static_cast<size_t>(c)];
    for (int i = kN - 1; i >= 1; --i) {
      double s = slopes[i][c];
      for (int k = i + 1; k < kN; ++k) s -= l[k][i] * slopes[k][c];
      slopes[i][c] = s / l[i][i];
      base -= slopes[i][c] * mean[static_cast<size_t>(i)];
      fit.coefficients_[static_cast<size_t>(i)][c] = static_cast<float>(slopes[i][c]);
    }
    fit.coefficients_[0][c] = static_cast<float>(base);
    const double mean_color = color[static_cast<size_t>(c)];
    const double variance =
        sums[static_cast<size_t>(kSquares + c)] / total - mean_color * mean_color;
    const double reach = 3.0 * std::sqrt(std::max(variance, 0.0));
    fit.low_[c] = static_cast<float>(mean_color - reach);
    fit.high_[c] = static_cast<float>(mean_color + reach);
  }
  return fit;
}

}  // namespace hyades::core
