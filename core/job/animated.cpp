#include "core/job/animated.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"

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
    case Ease::spline:
      return u;
  }
  return u;
}

float& component(float& value, int) { return value; }
template <class T>
float& component(T& value, int i) {
  return value[i];
}

/// `frame` within the keys' time.
double wrapped(Repeat repeat, double frame, double first, double last) {
  const double period = last - first;
  if (repeat == Repeat::none || !(period > 0.0)) return std::clamp(frame, first, last);
  double turns = (frame - first) / period;
  if (repeat == Repeat::loop) return first + (turns - std::floor(turns)) * period;
  turns -= 2.0 * std::floor(0.5 * turns);
  return first + (turns > 1.0 ? 2.0 - turns : turns) * period;
}

/// The slope at key `i` of a curve through all keys that never turns back between two (Fritsch &
/// Butland 1984, "A Method for Constructing Local Monotone Piecewise Cubic Interpolants").
template <class T>
double slope_at(const std::vector<Key<T>>& keys, size_t i, int c) {
  const auto secant = [&](size_t k) {
    T from = keys[k].value;
    T to = keys[k + 1].value;
    return (double{component(to, c)} - double{component(from, c)}) /
           (keys[k + 1].frame - keys[k].frame);
  };
  if (keys.size() < 2) return 0.0;
  if (i == 0) return secant(0);
  if (i + 1 == keys.size()) return secant(i - 1);
  const double before = secant(i - 1);
  const double after = secant(i);
  if (!(before * after > 0.0)) return 0.0;
  const double h0 = keys[i].frame - keys[i - 1].frame;
  const double h1 = keys[i + 1].frame - keys[i].frame;
  const double weight = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
  return before * after / (weight * after + (1.0 - weight) * before);
}

/// Hermite's cubic between two keys.
template <class T>
double on_spline(const std::vector<Key<T>>& keys, size_t i, double u, int c) {
  T from = keys[i].value;
  T to = keys[i + 1].value;
  const double a = component(from, c);
  const double b = component(to, c);
  const double h = keys[i + 1].frame - keys[i].frame;
  const double start = slope_at(keys, i, c) * h;
  const double end = slope_at(keys, i + 1, c) * h;
  return a +
         u * (start + u * (3.0 * (b - a) - 2.0 * start - end + u * (start + end - 2.0 * (b - a))));
}

}  // namespace

template <class T>
typename Animated<T>::Between Animated<T>::between(const JobTime& time) const {
  const double frame = wrapped(repeat, time.frame, keys.front().frame, keys.back().frame);
  if (!(frame > keys.front().frame)) return {};
  if (frame >= keys.back().frame) return {keys.size() - 1, keys.size() - 1, 0.0};
  const auto after = std::upper_bound(keys.begin(), keys.end(), frame,
                                      [](double f, const Key<T>& key) { return f < key.frame; });
  const auto second = static_cast<size_t>(after - keys.begin());
  const double u = (frame - keys[second - 1].frame) / (after->frame - keys[second - 1].frame);
  return {second - 1, second, eased(ease, u)};
}

template <class T>
T Animated<T>::at(const JobTime& time) const {
  T value = constant;
  if (!keys.empty()) {
    const Between place = between(time);
    T from = keys[place.first].value;
    T to = keys[place.second].value;
    value = from;
    for (int i = 0; i < kComponents && place.second != place.first; ++i) {
      const double a = component(from, i);
      const double b = component(to, i);
      component(value, i) = static_cast<float>(
          ease == Ease::spline ? on_spline(keys, place.first, place.u, i) : a + (b - a) * place.u);
    }
  }
  for (int i = 0; i < kComponents; ++i) {
    const auto& expression = expressions[static_cast<size_t>(i)];
    if (expression) component(value, i) = static_cast<float>(expression->evaluate(time));
  }
  return value;
}

Vec4 rotation_at(const Animated<Vec4>& quaternion, const JobTime& time) {
  const auto unit = [](const Vec4& q) {
    const float length = std::sqrt(glm::dot(q, q));
    return length > 0.0F ? q / length : Vec4(0.0F, 0.0F, 0.0F, 1.0F);
  };
  if (quaternion.keys.empty()) return unit(quaternion.constant);
  const auto place = quaternion.between(time);
  const Vec4 from = unit(quaternion.keys[place.first].value);
  Vec4 to = unit(quaternion.keys[place.second].value);
  float cosine = glm::dot(from, to);
  if (cosine < 0.0F) {  // the same rotation, nearer
    to = -to;
    cosine = -cosine;
  }
  const auto u = static_cast<float>(place.u);
  const float angle = acos(cosine);
  const float sine = sin(angle);
  if (!(sine > 1e-3F)) return unit(from * (1.0F - u) + to * u);
  return unit(from * (sin((1.0F - u) * angle) / sine) + to * (sin(u * angle) / sine));
}

template struct Animated<float>;
template struct Animated<Vec2>;
template struct Animated<Vec3>;
template struct Animated<Vec4>;

}  // namespace hyades::core
