#include <memory>
#include <optional>
#include <utility>

#include "core/materials/local.h"
#include "core/materials/params.h"
#include "core/materials/turned_bsdf.h"

namespace hyades::core {
namespace {

/// One of two BSDFs, picked by its share; a smooth direction is weighed by both, so that mixing
/// costs no variance. A missing one is black.
class MixBsdf final : public Bsdf {
 public:
  MixBsdf(const Bsdf* first, const Bsdf* second, float amount)
      : first_(first),
        second_(second),
        amount_(amount),
        // Black needs no samples.
        p_second_(first == nullptr ? 1.0F : (second == nullptr ? 0.0F : amount)) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    Rgb value(0.0F);
    if (first_ != nullptr) value += (1.0F - amount_) * first_->evaluate(wo, wi, mode);
    if (second_ != nullptr) value += amount_ * second_->evaluate(wo, wi, mode);
    return value;
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    Rgb value(0.0F);
    if (first_ != nullptr) value += (1.0F - amount_) * first_->evaluate_diffuse(wo, wi);
    if (second_ != nullptr) value += amount_ * second_->evaluate_diffuse(wo, wi);
    return value;
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    float density = 0.0F;
    if (first_ != nullptr) density += (1.0F - p_second_) * first_->pdf(wo, wi, mode);
    if (second_ != nullptr) density += p_second_ * second_->pdf(wo, wi, mode);
    return density;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const bool take_second = lobe < p_second_;
    const Bsdf& taken = take_second ? *second_ : *first_;
    const float probability = take_second ? p_second_ : 1.0F - p_second_;
    const float share = take_second ? amount_ : 1.0F - amount_;
    const float rest = rest_of(lobe, take_second ? 0.0F : p_second_, probability);
    auto s = taken.sample(wo, rest, u, mode);
    if (!s) return std::nullopt;
    if (s->delta) {
      s->weight *= share / probability;
      s->pdf *= probability;
      return s;
    }
    s->pdf = pdf(wo, s->wi, mode);
    if (!(s->pdf > 0.0F)) return std::nullopt;
    s->weight = evaluate(wo, s->wi, mode) / s->pdf;
    return s;
  }

  Rgb albedo(const Vec3& wo) const override {
    Rgb value(0.0F);
    if (first_ != nullptr) value += (1.0F - amount_) * first_->albedo(wo);
    if (second_ != nullptr) value += amount_ * second_->albedo(wo);
    return value;
  }

  Spread spread(float outer) const override {
    Spread both;
    if (first_ != nullptr) both.add(first_->spread(outer), Rgb(1.0F - amount_));
    if (second_ != nullptr) both.add(second_->spread(outer), Rgb(amount_));
    return both;
  }

  bool has_smooth() const override {
    return (first_ != nullptr && first_->has_smooth()) ||
           (second_ != nullptr && second_->has_smooth());
  }

 private:
  const Bsdf* first_;
  const Bsdf* second_;
  float amount_;
  float p_second_;
};

class Mix final : public Material {
 public:
  Mix(MaterialPtr first, MaterialPtr second, ScalarParam amount)
      : first_(std::move(first)), second_(std::move(second)), amount_(std::move(amount)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    const float amount = amount_of_surface(point);
    if (amount == 0.0F) return first_->bsdf_at(point, frame, arena);
    if (amount == 1.0F) return second_->bsdf_at(point, frame, arena);
    // Each part may turn its own normal; the mix keeps the one it was given.
    const Bsdf* first = bsdf_in_frame(*first_, point, frame, arena);
    const Bsdf* second = bsdf_in_frame(*second_, point, frame, arena);
    if (first == nullptr && second == nullptr) return nullptr;
    return arena.make<MixBsdf>(first, second, amount);
  }

  float opacity(const SurfacePoint& point) const override {
    if (!is_cutout()) return 1.0F;
    const float amount = fraction_at(amount_, point);
    return (1.0F - amount) * first_->opacity(point) + amount * second_->opacity(point);
  }
  bool is_cutout() const override { return first_->is_cutout() || second_->is_cutout(); }
  bool is_null() const override { return first_->is_null() && second_->is_null(); }
  bool diffuses_evenly() const override {
    return first_->diffuses_evenly() && second_->diffuses_evenly();
  }
  bool leads_inside() const override { return first_->leads_inside() || second_->leads_inside(); }
  float index() const override {
    return first_->index() > 0.0F ? first_->index() : second_->index();
  }

 private:
  /// The share of `second` in what is there: a part that is half transparent counts half.
  float amount_of_surface(const SurfacePoint& point) const {
    const float amount = fraction_at(amount_, point);
    if (!is_cutout()) return amount;
    const float first = (1.0F - amount) * first_->opacity(point);
    const float second = amount * second_->opacity(point);
    return first + second > 0.0F ? second / (first + second) : amount;
  }

  MaterialPtr first_;
  MaterialPtr second_;
  ScalarParam amount_;
};

}  // namespace

MaterialPtr make_mix(MaterialPtr first, MaterialPtr second, const ScalarParam& amount) {
  return std::make_shared<Mix>(std::move(first), std::move(second), amount);
}

}  // namespace hyades::core
