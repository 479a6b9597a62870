#pragma once

#include <algorithm>
#include <cmath>

/// Grids on which what facets reflect is tabulated.
namespace hyades::core {

inline float lerp(float a, float b, float part) { return a + part * (b - a); }

/// A place between two of a table's even nodes.
struct GridPlace {
  int node;
  float part;

  /// `x` in 0..1 among `count` nodes.
  static GridPlace at(float x, int count) {
    const float scaled = std::clamp(x, 0.0F, 1.0F) * static_cast<float>(count - 1);
    const int node = std::min(static_cast<int>(scaled), count - 2);
    return {node, scaled - static_cast<float>(node)};
  }

  template <class Values>
  float in(const Values& values) const {
    return lerp(values[node], values[node + 1], part);
  }
};

/// Column 0..1 of a cosine. At grazing angles what facets reflect depends on cosine / alpha, far
/// from them hardly at all: even steps in this are bent least by interpolation.
inline float energy_column(float cosine, float alpha) {
  return cosine > 0.0F ? std::sqrt(cosine * (1.0F + alpha) / (cosine + alpha)) : 0.0F;
}

/// The cosine whose energy_column() is `column`.
inline float energy_cosine(float column, float alpha) {
  const float square = column * column;
  return std::min(1.0F, square * alpha / (1.0F + alpha - square));
}

}  // namespace hyades::core
