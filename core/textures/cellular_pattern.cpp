#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/base/hash.h"
#include "core/textures/pattern.h"

namespace hyades::core {
namespace {

constexpr float kFarthest = 2.0F;  ///< that is searched; farther points count as that far

/// Four random numbers in [0, 1) of a cell, 16 bits each.
struct CellNumbers {
  uint64_t bits;
  float operator[](int i) const {
    return static_cast<float>((bits >> (16U * static_cast<unsigned>(i))) & 0xFFFFU) * 0x1p-16F;
  }
};

CellNumbers numbers_of(const Vec4& cell) {
  const auto word = [](float x) {
    return static_cast<uint64_t>(static_cast<uint32_t>(static_cast<int64_t>(x)));
  };
  return {mix64(mix64(word(cell.x) | word(cell.y) << 32U) + (word(cell.z) | word(cell.w) << 32U))};
}

/// A distance, and how it changes with the place.
struct Reached {
  float distance = kFarthest;
  Vec3 gradient{0.0F};
};

class Cellular final : public Pattern {
 public:
  explicit Cellular(const CellularDesc& desc) : desc_(desc) {}

  Noise3 at(const Vec3& p) const override {
    const Vec4 place(p, desc_.time.value_or(0.0F));
    const Vec4 middle = glm::floor(place);
    if (!(std::abs(middle.x) < 0x1p62F && std::abs(middle.y) < 0x1p62F &&
          std::abs(middle.z) < 0x1p62F && std::abs(middle.w) < 0x1p62F)) {
      return {};
    }
    // Cells next to this one hold all points within 1, those next to them all within 2.
    Nearest found = search(place, middle, 1.0F);
    if (found.second.distance > 1.0F && desc_.feature != CellFeature::f1) {
      found = search(place, middle, 2.0F);
    }
    const Reached first = found.first;
    const Reached second = found.second;
    switch (desc_.feature) {
      case CellFeature::f2:
        return held(second);
      case CellFeature::edges:
        return held({second.distance - first.distance, second.gradient - first.gradient});
      case CellFeature::cell_id:
        return {found.id, Vec3(0.0F)};
      case CellFeature::f1:
        break;
    }
    return held(first);
  }

 private:
  struct Nearest {
    Reached first;
    Reached second;
    float id = 0.0F;  ///< of the first one's cell
  };

  /// Among the points of the cells up to `reach` cells away.
  Nearest search(const Vec4& place, const Vec4& middle, float reach) const {
    Nearest n;
    float nearest = 1e30F;
    const float ages = desc_.time ? reach : 0.0F;
    for (float w = -ages; w <= ages; ++w) {
      for (float z = -reach; z <= reach; ++z) {
        for (float y = -reach; y <= reach; ++y) {
          for (float x = -reach; x <= reach; ++x) {
            const Vec4 cell = middle + Vec4(x, y, z, w);
            const CellNumbers random = numbers_of(cell);
            const Vec4 offset = place - point_in(cell, random);
            const float distance = length_of(offset);
            if (distance < nearest) {
              nearest = distance;
              n.id = static_cast<float>(mix64(random.bits) >> 40U) * 0x1p-24F;
            }
            if (!(distance < n.second.distance)) continue;
            const Reached found{distance, gradient_of(offset, distance)};
            n.second = distance < n.first.distance ? n.first : found;
            if (distance < n.first.distance) n.first = found;
          }
        }
      }
    }
    return n;
  }

  /// At most 1.
  static Noise3 held(const Reached& reached) {
    if (reached.distance >= 1.0F) return {1.0F, Vec3(0.0F)};
    return {reached.distance, reached.gradient};
  }

  Vec4 point_in(const Vec4& cell, const CellNumbers& random) const {
    Vec4 point = cell + 0.5F;
    const int dimensions = desc_.time ? 4 : 3;
    for (int i = 0; i < dimensions; ++i) point[i] += desc_.jitter * (random[i] - 0.5F);
    if (!desc_.time) point.w = 0.0F;
    return point;
  }

  float length_of(const Vec4& d) const {
    const Vec4 a = glm::abs(d);
    switch (desc_.metric) {
      case CellMetric::manhattan:
        return (a.x + a.y) + (a.z + a.w);
      case CellMetric::chebyshev:
        return std::max(std::max(a.x, a.y), std::max(a.z, a.w));
      case CellMetric::euclidean:
        break;
    }
    return std::sqrt((d.x * d.x + d.y * d.y) + (d.z * d.z + d.w * d.w));
  }

  Vec3 gradient_of(const Vec4& d, float distance) const {
    const Vec3 sign(d.x < 0.0F ? -1.0F : 1.0F, d.y < 0.0F ? -1.0F : 1.0F,
                    d.z < 0.0F ? -1.0F : 1.0F);
    switch (desc_.metric) {
      case CellMetric::manhattan:
        return sign;
      case CellMetric::chebyshev: {
        const Vec4 a = glm::abs(d);
        if (a.w == distance) return Vec3(0.0F);
        if (a.x == distance) return {sign.x, 0.0F, 0.0F};
        if (a.y == distance) return {0.0F, sign.y, 0.0F};
        return {0.0F, 0.0F, sign.z};
      }
      case CellMetric::euclidean:
        break;
    }
    return distance > 0.0F ? Vec3(d) / distance : Vec3(0.0F);
  }

  CellularDesc desc_;
};

}  // namespace

PatternPtr make_cellular_pattern(const CellularDesc& desc) {
  return std::make_shared<Cellular>(desc);
}

}  // namespace hyades::core
