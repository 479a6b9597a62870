#include "import/pbrt/hot_spot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hyades::core::pbrt {
namespace {

constexpr double kStep = 10.0;  ///< K

/// Jobs show what is hotter as that.
constexpr double kHottest = 20'000.0;

/// The luminance of a black body whose spectrum is brought to a peak of 1, as pbrt's is: the
/// integral with the observer's y. Planck's law and the fit of Wyman et al. 2013.
double luminance_of_peak_one(double kelvin) {
  if (!(kelvin >= 1.0)) return 0.0;
  const auto planck = [&](double nm) {
    const double x = 1.4387769e7 / (nm * kelvin);
    return x > 700.0 ? 0.0 : 1.0 / (std::pow(nm, 5.0) * std::expm1(x));
  };
  const double peak = planck(2.8977721e6 / kelvin);
  double sum = 0.0;
  for (double nm = 360.0; nm <= 830.0; nm += 5.0) {
    const double a = (nm - 568.8) * (nm < 568.8 ? 0.0213 : 0.0247);
    const double b = (nm - 530.9) * (nm < 530.9 ? 0.0613 : 0.0322);
    const double y = 0.821 * std::exp(-0.5 * a * a) + 0.286 * std::exp(-0.5 * b * b);
    sum += 5.0 * y * planck(nm) / peak;
  }
  return sum;
}

/// luminance_of_peak_one() from a table: grids have millions of points.
double tabulated_luminance(double kelvin) {
  static const std::vector<double> table = [] {
    std::vector<double> values;
    for (double k = 0.0; k <= kHottest + kStep; k += kStep) {
      values.push_back(luminance_of_peak_one(k));
    }
    return values;
  }();
  if (kelvin >= kHottest) return luminance_of_peak_one(kelvin);
  const double place = kelvin / kStep;
  const auto i = static_cast<size_t>(place);
  return std::lerp(table[i], table[i + 1], place - static_cast<double>(i));
}

}  // namespace

HotSpot hot_spot(float kelvin) {
  if (!(kelvin > 100.0F) || !std::isfinite(kelvin)) return {};
  const auto k = static_cast<double>(kelvin);
  const double share = std::min(k, kHottest) / 1500.0;
  return {kelvin, static_cast<float>(tabulated_luminance(k) / (share * share * share * share))};
}

}  // namespace hyades::core::pbrt
