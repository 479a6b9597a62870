#include "core/geometry/weld.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace hyades::core {
namespace {

/// For each of `count` the first that has the same key.
template <class Key>
std::vector<uint32_t> first_of_each(size_t count, const Key& key) {
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  std::vector<uint32_t> first(count);
  for (size_t i = 0; i < count; ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

auto key_of(const Vec3& v) { return std::tuple(v.x, v.y, v.z); }

}  // namespace

std::vector<uint32_t> weld(const std::vector<Vec3>& positions) {
  return first_of_each(positions.size(), [&](uint32_t i) { return key_of(positions[i]); });
}

std::vector<uint32_t> weld(const std::vector<Vec3>& positions, const std::vector<Vec3>& normals) {
  return first_of_each(positions.size(), [&](uint32_t i) {
    return std::tuple_cat(key_of(positions[i]), key_of(normals[i]));
  });
}

}  // namespace hyades::core
