#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/elementary.h"
#include "core/textures/pattern.h"

namespace hyades::core {
namespace {

/// A number of one variable and its slope.
struct Profile {
  float value = 0.0F;
  float slope = 0.0F;
};

/// From 0 at `low` to 1 at `high`, smoothly; a step where they are the same.
Profile smooth_step(float low, float high, float x) {
  if (x < low || (x == low && high > low)) return {0.0F, 0.0F};
  if (x >= high) return {1.0F, 0.0F};
  const float u = (x - low) / (high - low);
  return {u * u * (3.0F - 2.0F * u), 6.0F * u * (1.0F - u) / (high - low)};
}

/// 1 around whole numbers, on `width` of each unit, and softly down to 0 towards their middles.
Profile line(float x, float width, float softness) {
  const float t = x - std::floor(x + 0.5F);  // -0.5 to 0.5
  const float edge = 0.5F * width;
  const Profile inside = smooth_step(edge, edge + softness * (0.5F - edge), std::abs(t));
  return {1.0F - inside.value, t < 0.0F ? inside.slope : -inside.slope};
}

/// Where either is.
Noise3 either(const Profile& x, const Profile& y) {
  const float value = 1.0F - (1.0F - x.value) * (1.0F - y.value);
  return {value, {x.slope * (1.0F - y.value), y.slope * (1.0F - x.value), 0.0F}};
}

class Brick final : public Pattern {
 public:
  Brick(float mortar, float shift, float softness)
      : mortar_(mortar), shift_(shift), softness_(softness) {}

  Noise3 at(const Vec3& p) const override {
    const float row = std::floor(p.y);
    const float half = 0.5F * row;
    const float moved = half != std::floor(half) ? p.x + shift_ : p.x;
    return either(line(moved, mortar_, softness_), line(p.y, mortar_, softness_));
  }

 private:
  float mortar_;
  float shift_;
  float softness_;
};

class Lines final : public Pattern {
 public:
  Lines(bool grid, float width, float softness) : grid_(grid), width_(width), softness_(softness) {}

  Noise3 at(const Vec3& p) const override {
    return either(line(p.x, width_, softness_), grid_ ? line(p.y, width_, softness_) : Profile{});
  }

 private:
  bool grid_;
  float width_;
  float softness_;
};

class Gradient final : public Pattern {
 public:
  explicit Gradient(GradientShape shape) : shape_(shape) {}

  Noise3 at(const Vec3& p) const override {
    const Noise3 n = unheld(p);
    if (!(n.value > 0.0F)) return {0.0F, Vec3(0.0F)};
    if (n.value >= 1.0F) return {1.0F, Vec3(0.0F)};
    return n;
  }

 private:
  Noise3 unheld(const Vec3& p) const {
    switch (shape_) {
      case GradientShape::radial:
        return length_of({p.x, p.y, 0.0F});
      case GradientShape::cylindrical:
        return length_of({p.x, 0.0F, p.z});
      case GradientShape::spherical:
        return length_of(p);
      case GradientShape::angular: {
        const float length2 = p.x * p.x + p.y * p.y;
        if (!(length2 > 0.0F)) return {};
        const float turn = atan2(p.y, p.x) * (0.5F * kInvPi);
        return {turn < 0.0F ? turn + 1.0F : turn,
                Vec3(-p.y, p.x, 0.0F) * (0.5F * kInvPi / length2)};
      }
      case GradientShape::linear:
        break;
    }
    return {p.x, {1.0F, 0.0F, 0.0F}};
  }

  static Noise3 length_of(const Vec3& v) {
    const float length = std::sqrt(glm::dot(v, v));
    return {length, length > 0.0F ? v / length : Vec3(0.0F)};
  }

  GradientShape shape_;
};

}  // namespace

PatternPtr make_brick_pattern(float mortar, float shift, float softness) {
  return std::make_shared<Brick>(mortar, shift, softness);
}
PatternPtr make_line_pattern(bool grid, float width, float softness) {
  return std::make_shared<Lines>(grid, width, softness);
}
PatternPtr make_gradient_pattern(GradientShape shape) { return std::make_shared<Gradient>(shape); }

}  // namespace hyades::core
