#pragma once

#include <functional>
#include <memory>

#include "core/media/grid_fields.h"
#include "core/media/make_medium.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

/// Volumes to try varying media with.
namespace hyades::core {

/// As dense everywhere in a box.
class EvenDensity final : public DensityField {
 public:
  EvenDensity(const Bounds& bounds, float density) : bounds_(bounds), density_(density) {}
  float at(const Vec3& p) const override {
    return p == glm::clamp(p, bounds_.lower, bounds_.upper) ? density_ : 0.0F;
  }
  Extent over(const Bounds&) const override { return {density_, density_}; }
  Bounds bounds() const override { return bounds_; }

 private:
  Bounds bounds_;
  float density_;
};

/// `n`^3 random values in [0, 1), some of them, in clumps, 0.
inline std::shared_ptr<const BrickGrid<float>> random_grid(int n, uint64_t seed) {
  const auto value = [=](const Vec3i& p) {
    const Vec3i clump = p / 5;
    if ((clump.x + clump.y + clump.z) % 3 == 1) return 0.0F;
    const auto cell = static_cast<uint64_t>((p.z * n + p.y) * n + p.x);
    return static_cast<float>(mix64(hash_combine(seed, cell)) >> 40) * 0x1p-24F;
  };
  return std::make_shared<const BrickGrid<float>>(Vec3i(0), Vec3i(n - 1), value);
}

inline std::shared_ptr<const Volume> volume_of(std::shared_ptr<const DensityField> field,
                                               const Vec3i& cells, float slack = 1.0F) {
  return std::make_shared<const Volume>(
      Volume{field, std::make_shared<const MajorantGrid>(*field, cells, slack), nullptr, nullptr});
}

/// Integral of the field's density over the first `t` of the way.
inline double density_along(const DensityField& field, const Ray& ray, double t) {
  return test::integrate([&](double s) { return double{field.at(ray.at(static_cast<float>(s)))}; },
                         0.0, t, 1e-5, 256, 12);
}

inline Vec4 random4(test::Random& random) {
  const Vec2 a = random.uniform2();
  const Vec2 b = random.uniform2();
  return {a.x, a.y, b.x, b.y};
}

}  // namespace hyades::core
