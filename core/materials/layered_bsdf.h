#pragma once

#include <cmath>
#include <optional>

#include "core/materials/bsdf.h"
#include "core/materials/coat_lobe.h"
#include "core/materials/layer_loss.h"

namespace hyades::core {

/// Tints nothing.
struct NoTint {
  static Rgb at(const Vec3&, const Vec3&) { return Rgb(1.0F); }
};

/// A lobe (coat_lobe.h) over a BSDF; what lies beneath gets T(w) = 1 - share(w). Diffuse light is
/// weighed by T(o) T(i) / mean T where it is even, which is reciprocal and loses nothing (Kulla and
/// Conty 2017); everything else by the lesser of T(o) and T(i), which is exact for mirrors, and
/// what that loses of wider lobes is given back in a lobe of its own (LayerLight). `Tint`: what the
/// layer takes from light that goes through, for two directions outside.
template <class Lobe, class Tint>
class LayeredBsdf final : public Bsdf {
 public:
  /// `base` null: black. `solid`: the layer is on the outer side only. `even`: what `base` reflects
  /// diffusely is (Material::diffuses_evenly).
  LayeredBsdf(const Lobe& lobe, const Tint& tint, const Bsdf* base, bool solid, bool even)
      : lobe_(lobe), tint_(tint), base_(base), solid_(solid) {
    const float mean = 1.0F - lobe.mean_share();
    if (even && mean > 0.0F) diffuse_scale_ = 1.0F / mean;
    if (base == nullptr) return;
    Spread outside = base->spread(1.0F);
    Spread inside = base->spread(-1.0F);
    const bool alike = !solid && inside == outside;
    // What is given back on the other side must be the same from there: sheets only.
    if (!alike) {
      for (Spread* side : {&outside, &inside}) side->wide_through = side->lobe_through = Rgb(0.0F);
    }
    add_lost(0, outside);
    if (alike) {
      lost_[1] = lost_[0];
    } else if (!solid) {
      add_lost(1, inside);
    }
  }

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    if (wo.z == 0.0F || wi.z == 0.0F) return Rgb(0.0F);
    const float to = beneath(wo);
    const float from = beneath(wi);
    Rgb value(0.0F);
    if (base_ != nullptr) {
      value = base_->evaluate(wo, wi, mode) * std::fmin(to, from);
      if (diffuse_scale_ > 0.0F && covered(wo) && same_side(wo, wi)) {
        value +=
            base_->evaluate_diffuse(wo, wi) * (to * from * diffuse_scale_ - std::fmin(to, from));
      }
      if (const auto& lost = lost_at(wo))
        value += lost->value(std::abs(wo.z), std::abs(wi.z), !same_side(wo, wi)) * std::abs(wi.z);
      value *= tint_.at(wo, wi);
    }
    if (same_side(wo, wi) && covered(wo)) value += lobe_.reflect(above(wo), above(wi));
    return value;
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    if (base_ == nullptr || !same_side(wo, wi)) return Rgb(0.0F);
    const float to = beneath(wo);
    const float from = beneath(wi);
    const bool even = diffuse_scale_ > 0.0F && covered(wo);
    return base_->evaluate_diffuse(wo, wi) * tint_.at(wo, wi) *
           (even ? to * from * diffuse_scale_ : std::fmin(to, from));
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    return pdf(lobes_of(wo), wo, wi, mode);
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    if (wo.z == 0.0F) return std::nullopt;
    const Lobes p = lobes_of(wo);
    BsdfSample s;
    if (lobe < p.layer) {
      const Vec3 o = above(wo);
      if (lobe_.is_mirror()) {
        return BsdfSample{
            .weight = lobe_.mirror(o) / p.layer, .pdf = p.layer, .wi = mirrored(wo), .delta = true};
      }
      const Vec3 i = lobe_.draw(o, u);
      if (!(i.z > 0.0F)) return std::nullopt;
      s.wi = {i.x, i.y, i.z * side(wo)};
    } else if (lobe < p.layer + p.lost) {
      const Vec3 i = square_to_cosine_hemisphere(u);
      s.transmitted = rest_of(lobe, p.layer, p.lost) < lost_at(wo)->through_share();
      s.wi = {i.x, i.y, s.transmitted ? -i.z * side(wo) : i.z * side(wo)};
    } else {
      if (base_ == nullptr) return std::nullopt;
      const float rest = 1.0F - p.layer - p.lost;
      auto drawn = base_->sample(wo, rest_of(lobe, p.layer + p.lost, rest), u, mode);
      if (!drawn) return std::nullopt;
      if (drawn->delta) {
        drawn->weight *=
            tint_.at(wo, drawn->wi) * (std::fmin(beneath(wo), beneath(drawn->wi)) / rest);
        drawn->pdf *= rest;
        return drawn;
      }
      s = *drawn;
    }
    s.pdf = pdf(p, wo, s.wi, mode);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    return s;
  }

  Rgb albedo(const Vec3& wo) const override {
    const float share = beneath(wo);
    return base_ != nullptr
               ? Rgb(1.0F - share) + base_->albedo(wo) * tint_.at(wo, mirrored(wo)) * share
               : Rgb(1.0F - share);
  }

  Spread spread(float outer) const override {
    Spread all;
    const bool layered = covered({0.0F, 0.0F, outer});
    const float mean = layered ? lobe_.mean_share() : 0.0F;
    if (layered) all.add(lobe_.spread(), Rgb(1.0F));
    const Vec3 straight(0.0F, 0.0F, outer);
    if (base_ != nullptr)
      all.add(base_->spread(outer), tint_.at(straight, straight) * (1.0F - mean));
    return all;
  }

  bool has_smooth() const override {
    return !lobe_.is_mirror() || (base_ != nullptr && base_->has_smooth());
  }

 private:
  bool covered(const Vec3& w) const { return !solid_ || w.z >= 0.0F; }
  /// T
  float beneath(const Vec3& w) const { return covered(w) ? 1.0F - lobe_.share(above(w)) : 1.0F; }

  /// Probabilities; the rest is for what lies beneath.
  struct Lobes {
    float layer = 0.0F;
    float lost = 0.0F;
  };

  const std::optional<LayerLight>& lost_at(const Vec3& w) const { return lost_[w.z < 0.0F]; }

  void add_lost(int n, Spread spread) {
    const Rgb all = spread.back() + spread.through();
    // Weighed without loss (evaluate()).
    if (diffuse_scale_ > 0.0F) spread.wide = Rgb(0.0F);
    if (is_black(spread.back() + spread.through())) return;
    const LayerLoss loss(
        [&](float cosine) {
          return 1.0F - lobe_.share({0.0F, std::sqrt(1.0F - cosine * cosine), cosine});
        },
        spread.alpha);
    const LayerLight light(loss, spread, all);
    if (!light.is_none()) lost_[n].emplace(light);
  }

  Lobes lobes_of(const Vec3& wo) const {
    if (!covered(wo)) return {};
    const float share = lobe_.share(above(wo));
    if (base_ == nullptr) return {share > 0.0F ? 1.0F : 0.0F, 0.0F};
    const float base = (1.0F - share) * max_component(base_->albedo(wo));
    const auto& light = lost_at(wo);
    const float lost = light ? max_component(light->part(std::abs(wo.z))) : 0.0F;
    const float all = std::fmax(share + lost + base, 1e-6F);
    // A base may reflect more than it says.
    const float most = std::fmin(1.0F, 0.95F * all / std::fmax(share + lost, 1e-6F));
    return {share / all * most, lost / all * most};
  }

  float pdf(const Lobes& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    if (wo.z == 0.0F || wi.z == 0.0F) return 0.0F;
    float density = 0.0F;
    const float rest = 1.0F - p.layer - p.lost;
    if (base_ != nullptr && rest > 0.0F) density = rest * base_->pdf(wo, wi, mode);
    const bool back = same_side(wo, wi);
    if (p.layer > 0.0F && back) density += p.layer * lobe_.pdf(above(wo), above(wi));
    if (p.lost > 0.0F) {
      const float through = lost_at(wo)->through_share();
      density += p.lost * (back ? 1.0F - through : through) * cosine_hemisphere_pdf(std::abs(wi.z));
    }
    return density;
  }

  Lobe lobe_;
  Tint tint_;
  const Bsdf* base_;
  bool solid_;
  float diffuse_scale_ = 0.0F;         ///< 1 / mean T; 0: the base is not even
  std::optional<LayerLight> lost_[2];  ///< from above, from below
};

}  // namespace hyades::core
