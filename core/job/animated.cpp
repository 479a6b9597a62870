#include "core/job/animated.h"

#include <algorithm>
#include <cmath>

namespace hyades::core {

namespace {

double eased(Ease ease, double u) {
  switch (ease) {
    case Ease::linear:
      return u;
    case Ease::smooth:
      return u * u * (3.0 - 2.0 * u);
    case Ease::step:
      return 0.0;
    case Ease::in:
      return u * u;
    case Ease::out:
      return u * (2.0 - u);
  }
  return u;
}

float& component(float& value, int) { return value; }
template <class T>
float& component(T& value, int i) {
  return value[i];
}

template <class T>
T between(const std::vector<Key<T>>& keys, Ease ease, double frame) {
  if (!(frame > keys.front().frame)) return keys.front().value;
  if (frame >= keys.back().frame) return keys.back().value;
  const auto after = std::upper_bound(keys.begin(), keys.end(), frame,
                                      [](double f, const Key<T>& key) { return f < key.frame; });
  const Key<T>& next = *after;
  const Key<T>& last = *(after - 1);
  const double u = eased(ease, (frame - last.frame) / (next.frame - last.frame));
  T result = last.value;
  T from = last.value;
  T to = next.value;
  for (int i = 0; i < Animated<T>::kComponents; ++i) {
    const double a = component(from, i);
    const double b = component(to, i);
    component(result, i) = static_cast<float>(a + (b - a) * u);
  }
  return result;
}

}  // namespace

template <class T>
T Animated<T>::at(const JobTime& time) const {
  T value = keys.empty() ? constant : between(keys, ease, time.frame);
  for (int i = 0; i < kComponents; ++i) {
    const auto& expression = expressions[static_cast<size_t>(i)];
    if (expression) component(value, i) = static_cast<float>(expression->evaluate(time));
  }
  return value;
}

template struct Animated<float>;
template struct Animated<Vec2>;
template struct Animated<Vec3>;

}  // namespace hyades::core
