#include "core/lights/angular_profile.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"
#include "core/base/frame.h"
#include "core/base/warp.h"

namespace hyades::core {
namespace {

class GridProfile final : public AngularProfile {
 public:
  /// `half`: the angle from the normal beyond which there is no light.
  explicit GridProfile(float half) : half_(sin_cos(half)) {
    // The integral of cos(t) (1 - tan(t) cot(h)) over the cone is pi (1 - h cot(h)); for small h
    // its series, as the difference loses all digits.
    const double h = double{half};
    const double left = h < 0.01 ? h * h / 3.0 + h * h * h * h / 45.0
                                 : 1.0 - h * double{half_.cos} / double{half_.sin};
    brighter_ = static_cast<float>(1.0 / left);
  }

  Rgb share(const Vec3& normal, const Vec3& outward) const override {
    const float cosine = glm::dot(normal, outward);
    if (!(cosine > half_.cos)) return Rgb(0.0F);
    const Vec3 across = glm::cross(normal, outward);
    const float sine = std::sqrt(glm::dot(across, across));
    return Rgb(std::max(1.0F - sine * half_.cos / (cosine * half_.sin), 0.0F) * brighter_);
  }

  /// Of the disk below the hemisphere (Malley's method) only the part below the cone.
  Vec3 choose(const Vec3& normal, const Vec2& u) const override {
    const Vec2 p = half_.sin * square_to_disk(u);
    const float z = std::sqrt(std::max(1.0F - glm::dot(p, p), 0x1p-24F));
    return Frame::around(normal).to_world({p.x, p.y, z});
  }
  float pdf(const Vec3& normal, const Vec3& outward) const override {
    const float cosine = glm::dot(normal, outward);
    return cosine > half_.cos ? cosine * kInvPi / (half_.sin * half_.sin) : 0.0F;
  }

  float mean() const override { return 1.0F; }

  void narrow(LightBounds& bounds) const override { bounds.cos_beyond = half_.cos; }

 private:
  SinCos half_;
  float brighter_;
};

}  // namespace

ProfilePtr make_spread(float spread) {
  constexpr float kAll = kPi - 1e-4F;
  constexpr float kNarrowest = 1e-3F;  // whose brightness float still holds
  if (spread >= kAll) return nullptr;
  return std::make_shared<const GridProfile>(0.5F * std::max(spread, kNarrowest));
}

}  // namespace hyades::core
