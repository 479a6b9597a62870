#include "core/film/black.h"

#include <algorithm>
#include <span>

#include "core/film/fixed128.h"

namespace hyades::core {

bool is_black(const Film& film) {
  for (int channel = 0; channel < 3; ++channel) {
    const std::span<const Fixed128> plane = film.plane(channel);
    const auto lit = std::find_if(plane.begin(), plane.end(),
                                  [](const Fixed128& sum) { return sum != Fixed128{}; });
    if (lit != plane.end()) return false;
  }
  return film.splats().empty();
}

bool is_dimmer_than(const Film& film, double light) {
  if (!film.splats().empty() || film.window().empty()) return false;
  const double samples = film.all_samples() / static_cast<double>(film.window().area());
  for (int channel = 0; channel < 3; ++channel) {
    const std::span<const Fixed128> plane = film.plane(channel);
    const bool dim = std::all_of(plane.begin(), plane.end(), [&](const Fixed128& sum) {
      return to_double(sum) < light * samples;
    });
    if (!dim) return false;
  }
  return true;
}

}  // namespace hyades::core
