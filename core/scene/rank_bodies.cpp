#include "core/scene/rank_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "core/base/elementary_kernels.h"

namespace hyades::core {
namespace {

/// Most bodies whose bounds are compared one by one.
constexpr size_t kMostCompared = 4096;

/// A number that grows with the volume, the same for volumes that differ by rounding (but for those
/// next to a step).
int64_t step_of(double volume) {
  constexpr double kStepsPerOctave = 1 << 13;
  // Below the normal numbers there is nothing to see; FpMode makes zeros of them.
  return volume >= std::numeric_limits<double>::min()
             ? std::llround(kStepsPerOctave * elementary::log2_finite(volume))
             : std::numeric_limits<int64_t>::min();
}

bool touch(const Bounds& a, const Bounds& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.lower[i] > b.upper[i] || b.lower[i] > a.upper[i]) return false;
  }
  return true;
}

}  // namespace

std::vector<uint32_t> rank_bodies(const std::vector<BodyExtent>& bodies) {
  std::vector<uint32_t> order(bodies.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const BodyExtent& left = bodies[a];
    const BodyExtent& right = bodies[b];
    if (left.priority != right.priority) return left.priority < right.priority;
    return step_of(left.volume) > step_of(right.volume);
  });
  std::vector<uint32_t> ranks(bodies.size());
  for (uint32_t place = 0; place < order.size(); ++place) ranks[order[place]] = place;
  return ranks;
}

std::vector<bool> may_be_hidden(const std::vector<BodyExtent>& bodies,
                                const std::vector<uint32_t>& ranks) {
  std::vector<bool> hidden(bodies.size(), false);
  std::vector<uint32_t> refracting;
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].refracts) refracting.push_back(i);
  }
  for (const uint32_t i : refracting) {
    hidden[i] = refracting.size() > kMostCompared ||
                std::any_of(refracting.begin(), refracting.end(), [&](uint32_t other) {
                  return ranks[other] > ranks[i] && touch(bodies[i].bounds, bodies[other].bounds);
                });
  }
  return hidden;
}

}  // namespace hyades::core
