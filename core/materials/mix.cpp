#include <algorithm>
#include <cmath>

#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// A BSDF whose normal was turned (by a bump map) away from the one its directions are given in.
/// Directions on different sides of the two normals carry nothing.
class TurnedBsdf final : public Bsdf {
 public:
  /// `turn`: the inner frame's axes in outer local coordinates.
  TurnedBsdf(const Bsdf& inner, const Frame& turn) : inner_(inner), turn_(turn) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    const Vec3 o = turn_.to_local(wo);
    const Vec3 i = turn_.to_local(wi);
    if (!same_side(o, wo) || !same_side(i, wi)) return Rgb(0.0F);
    return inner_.evaluate(o, i, mode) * adjoint_factor(wo, o, wi, i, mode);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    const Vec3 o = turn_.to_local(wo);
    const Vec3 i = turn_.to_local(wi);
    return same_side(o, wo) && same_side(i, wi) ? inner_.pdf(o, i, mode) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Vec3 o = turn_.to_local(wo);
    if (!same_side(o, wo)) return std::nullopt;
    auto s = inner_.sample(o, lobe, u, mode);
    if (!s) return std::nullopt;
    const Vec3 i = turn_.to_world(s->wi);
    if (!same_side(i, s->wi)) return std::nullopt;
    s->weight *= adjoint_factor(wo, o, i, s->wi, mode);
    s->wi = i;
    return s;
  }

  Rgb albedo(const Vec3& wo) const override { return inner_.albedo(turn_.to_local(wo)); }
  bool has_smooth() const override { return inner_.has_smooth(); }

 private:
  /// Importance is corrected for the outer normal (ShadedSurface), but scattered about this one
  /// (Veach 1997, section 5.3). `o` and `i` are wo and wi in the inner frame.
  static float adjoint_factor(const Vec3& wo, const Vec3& o, const Vec3& wi, const Vec3& i,
                              TransportMode mode) {
    if (mode == TransportMode::radiance) return 1.0F;
    return std::abs(o.z * wi.z) / std::max(std::abs(wo.z * i.z), 1e-12F);
  }

  const Bsdf& inner_;
  Frame turn_;
};

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
    const float amount = fraction_at(amount_, point);
    if (amount == 0.0F) return first_->bsdf_at(point, frame, arena);
    if (amount == 1.0F) return second_->bsdf_at(point, frame, arena);
    // Each part may turn its own normal; the mix keeps the one it was given.
    const Bsdf* first = in_frame(*first_, point, frame, arena);
    const Bsdf* second = in_frame(*second_, point, frame, arena);
    if (first == nullptr && second == nullptr) return nullptr;
    return arena.make<MixBsdf>(first, second, amount);
  }

  bool is_null() const override { return first_->is_null() && second_->is_null(); }
  bool leads_inside() const override { return first_->leads_inside() || second_->leads_inside(); }
  float index() const override {
    return first_->index() > 0.0F ? first_->index() : second_->index();
  }

 private:
  static const Bsdf* in_frame(const Material& material, const SurfacePoint& point,
                              const Frame& outer, BsdfArena& arena) {
    Frame inner = outer;
    const Bsdf* bsdf = material.bsdf_at(point, inner, arena);
    if (bsdf == nullptr || inner.n == outer.n) return bsdf;
    return arena.make<TurnedBsdf>(
        *bsdf, Frame{outer.to_local(inner.s), outer.to_local(inner.t), outer.to_local(inner.n)});
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
