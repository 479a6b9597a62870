#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace hyades::core {

/// What lies outside of an image.
enum class WrapMode { repeat, clamp, mirror, black };

/// What lies outside of an image along u, from left to right, and along v, from bottom to top.
struct WrapModes {
  WrapMode u = WrapMode::repeat;
  WrapMode v = WrapMode::repeat;

  WrapModes() = default;
  WrapModes(WrapMode both) : u(both), v(both) {}  // NOLINT: implicit on purpose: most have one
  WrapModes(WrapMode along_u, WrapMode along_v) : u(along_u), v(along_v) {}
  auto operator<=>(const WrapModes&) const = default;
};

/// Texel `i` of an endless row of n, as the wrap mode has it; -1 for black.
inline int wrap_index(int64_t i, int n, WrapMode wrap) {
  if (i >= 0 && i < n) return static_cast<int>(i);
  switch (wrap) {
    case WrapMode::clamp:
      return i < 0 ? 0 : n - 1;
    case WrapMode::black:
      return -1;
    case WrapMode::mirror: {
      const int64_t period = ((i % (2 * int64_t{n})) + 2 * int64_t{n}) % (2 * int64_t{n});
      return static_cast<int>(period < n ? period : 2 * int64_t{n} - 1 - period);
    }
    case WrapMode::repeat:
      break;
  }
  return static_cast<int>(((i % n) + n) % n);
}

/// Where one coordinate falls among n texels: the two neighbours (-1: black) and the weight of the
/// second.
struct Taps {
  int first;
  int second;
  float weight;
};

/// Coordinate x in texels: texel i covers [i, i + 1). `between`: the texels whose centres lie left
/// and right of it; else the one that it falls into.
inline Taps locate(double x, int n, WrapMode wrap, bool between) {
  const double shifted = between ? x - 0.5 : x;
  const double floor = std::floor(shifted);
  if (!(std::fabs(floor) < 0x1p62)) return {wrap_index(0, n, wrap), wrap_index(0, n, wrap), 0.0F};
  const auto i = static_cast<int64_t>(floor);
  const int first = wrap_index(i, n, wrap);
  if (!between) return {first, first, 0.0F};
  return {first, wrap_index(i + 1, n, wrap), static_cast<float>(shifted - floor)};
}

}  // namespace hyades::core
