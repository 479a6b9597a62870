#pragma once

#include <algorithm>
#include <cstdint>

namespace hyades::core {

/// Which vertices of two subpaths are joined: all of their first ones, and of later pairs so many
/// that long subpaths cost no more than in proportion to their length.
struct ChosenJoins {
  static constexpr int kFirst = 16;   ///< pairs up to these vertices of both are always joined
  static constexpr int kLater = 256;  ///< how many of the others at most, on average
};

/// Calls visit(s, t, weight) for pairs of s in [2, light] and t in [2, camera] vertices with s + t
/// at most `most`. Each pair is visited with probability 1 / weight (systematic sampling: of all
/// later pairs in a row every so manyth, from `u` in [0, 1) on), so that sums of what is visited,
/// times weight, are unbiased.
template <class Visit>
void for_chosen_joins(int light, int camera, int most, float u, const Visit& visit) {
  const auto last = [&](int t) { return std::min(light, most - t); };
  const auto first_later = [&](int t) {
    return t <= ChosenJoins::kFirst ? ChosenJoins::kFirst + 1 : 2;
  };
  int64_t later = 0;
  for (int t = 2; t <= camera; ++t) later += std::max(0, last(t) - first_later(t) + 1);
  const double step = std::max(1.0, static_cast<double>(later) / ChosenJoins::kLater);
  const auto weight = static_cast<float>(step);
  double next = static_cast<double>(u) * step;  // how many later pairs to pass over
  for (int t = 2; t <= camera; ++t) {
    for (int s = 2; s < first_later(t) && s <= last(t); ++s) visit(s, t, 1.0F);
    const int begin = first_later(t);
    const int row = std::max(0, last(t) - begin + 1);
    for (; next < row; next += step) visit(begin + static_cast<int>(next), t, weight);
    next -= row;
  }
}

}  // namespace hyades::core
