#include <algorithm>
#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// dot(weights, color), and what a weighed sum of channels adds for alpha, which is 1.
float weighed(const Vec4& weights, const Rgb& color) {
  return glm::dot(Vec3(weights), color) + weights.w;
}

Vec4 weights_of(const Vec3& color) { return Vec4(color, 0.0F); }

/// Two textures that become one, channel by channel.
class Pair : public Texture {
 public:
  Pair(TexturePtr a, TexturePtr b) : a_(std::move(a)), b_(std::move(b)) {}

 protected:
  /// Of value(a, b), whose derivatives by a and b are `by_a` and `by_b`.
  ScalarGradient sum_of(const TexturePoint& at, const Vec4& weights, const Rgb& value,
                        const Rgb& by_a, const Rgb& by_b) const {
    const Vec3 w(weights);
    ScalarGradient sum = weighted_sum(1.0F, a_->gradient(at, weights_of(w * by_a)), 1.0F,
                                      b_->gradient(at, weights_of(w * by_b)));
    sum.value = weighed(weights, value);
    return sum;
  }

  TexturePtr a_;
  TexturePtr b_;
};

class Product final : public Pair {
 public:
  using Pair::Pair;
  Rgb color(const TexturePoint& at) const override { return a_->color(at) * b_->color(at); }
  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Rgb a = a_->color(at);
    const Rgb b = b_->color(at);
    return sum_of(at, weights, a * b, b, a);
  }
};

class Sum final : public Pair {
 public:
  using Pair::Pair;
  Rgb color(const TexturePoint& at) const override { return a_->color(at) + b_->color(at); }
  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    return sum_of(at, weights, color(at), Rgb(1.0F), Rgb(1.0F));
  }
};

/// a over b; 0 where b is 0.
class Quotient final : public Pair {
 public:
  using Pair::Pair;
  Rgb color(const TexturePoint& at) const override { return a_->color(at) * inverse_of(at); }
  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Rgb a = a_->color(at);
    const Rgb inverse = inverse_of(at);
    return sum_of(at, weights, a * inverse, inverse, -a * inverse * inverse);
  }

 private:
  Rgb inverse_of(const TexturePoint& at) const {
    const Rgb b = b_->color(at);
    Rgb inverse(0.0F);
    for (int c = 0; c < 3; ++c) {
      if (b[c] != 0.0F) inverse[c] = 1.0F / b[c];
    }
    return inverse;
  }
};

/// The lesser or the greater of two, channel by channel.
class Extreme final : public Pair {
 public:
  Extreme(TexturePtr a, TexturePtr b, bool greater)
      : Pair(std::move(a), std::move(b)), greater_(greater) {}

  Rgb color(const TexturePoint& at) const override {
    const Rgb a = a_->color(at);
    const Rgb b = b_->color(at);
    return greater_ ? glm::max(a, b) : glm::min(a, b);
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Rgb a = a_->color(at);
    const Rgb b = b_->color(at);
    Rgb by_a;
    for (int c = 0; c < 3; ++c) by_a[c] = (a[c] < b[c]) != greater_ ? 1.0F : 0.0F;
    return sum_of(at, weights, by_a * a + (1.0F - by_a) * b, by_a, 1.0F - by_a);
  }

 private:
  bool greater_;
};

class Mix final : public Pair {
 public:
  Mix(TexturePtr a, TexturePtr b, TexturePtr amount)
      : Pair(std::move(a), std::move(b)), amount_(std::move(amount)) {}

  Rgb color(const TexturePoint& at) const override {
    const float w = share(at);
    if (w == 0.0F) return a_->color(at);
    if (w == 1.0F) return b_->color(at);
    return (1.0F - w) * a_->color(at) + w * b_->color(at);
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const float w = share(at);
    const Rgb a = a_->color(at);
    const Rgb b = b_->color(at);
    ScalarGradient sum = sum_of(at, weights, (1.0F - w) * a + w * b, Rgb(1.0F - w), Rgb(w));
    const ScalarGradient amount = amount_->scalar_gradient(at);
    if (amount.value < 0.0F || amount.value > 1.0F) return sum;
    const float value = sum.value;
    sum = weighted_sum(1.0F, sum, glm::dot(Vec3(weights), b - a), amount);
    sum.value = value;
    return sum;
  }

 private:
  float share(const TexturePoint& at) const { return std::clamp(amount_->scalar(at), 0.0F, 1.0F); }

  TexturePtr amount_;
};

}  // namespace

TexturePtr make_scale_texture(TexturePtr input, TexturePtr factor) {
  return std::make_shared<Product>(std::move(input), std::move(factor));
}
TexturePtr make_sum_texture(TexturePtr a, TexturePtr b) {
  return std::make_shared<Sum>(std::move(a), std::move(b));
}
TexturePtr make_quotient_texture(TexturePtr a, TexturePtr b) {
  return std::make_shared<Quotient>(std::move(a), std::move(b));
}
TexturePtr make_extreme_texture(TexturePtr a, TexturePtr b, bool greater) {
  return std::make_shared<Extreme>(std::move(a), std::move(b), greater);
}
TexturePtr make_mix_texture(TexturePtr a, TexturePtr b, TexturePtr amount) {
  return std::make_shared<Mix>(std::move(a), std::move(b), std::move(amount));
}

}  // namespace hyades::core
