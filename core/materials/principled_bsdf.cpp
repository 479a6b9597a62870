#include "core/materials/principled_bsdf.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/materials/fresnel.h"
#include "core/materials/hemisphere_mean.h"

namespace hyades::core {
namespace {

/// The cosine at which metals are tinted (Kutz, Hasan and Edmondson 2021, "Novel Aspects of the
/// Adobe Standard Material"): near 82 degrees, where what Schlick's formula bends most.
constexpr float kEdgeCosine = 1.0F / 7.0F;

}  // namespace

PrincipledBsdf::PrincipledBsdf(const PrincipledParts& parts)
    : parts_(parts),
      interface_(parts.eta),
      white_(parts.facets),
      plain_((1.0F - parts.metallic) * (1.0F - parts.glassy)) {
  if ((parts_.coat || parts_.fuzz) && !mirrors()) {
    layer_loss_.emplace(
        [&](float cosine) {
          return layers_of({0.0F, std::sqrt(1.0F - cosine * cosine), cosine}).beneath;
        },
        parts_.alpha);
  }
  if (plain_ > 0.0F) {
    const auto scale = [](float mean) { return mean > 0.0F ? kInvPi / mean : 0.0F; };
    matt_scale_ = scale(mean_rest(true));
    bare_scale_ = parts_.solid ? scale(mean_rest(false)) : matt_scale_;
  }
  if (parts_.metallic > 0.0F) {
    const float fall = 1.0F - kEdgeCosine;
    const float steep = fifth_power(fall);
    const Rgb there = parts_.metal + (Rgb(1.0F) - parts_.metal) * steep;
    metal_bend_ = there * (Rgb(1.0F) - parts_.metal_edge) / (kEdgeCosine * steep * fall);
    if (!mirrors() && parts_.metal_keeps_light) {
      const float loss = white_.mean_loss();
      const Rgb f = mean_metal_reflectance();
      lost_tint_ = f * f * (1.0F - loss) / (Rgb(1.0F) - f * loss);
      lost_scale_ = loss > 0.0F ? kInvPi / loss : 0.0F;
    }
  }
  if (layer_loss_ && plain_ < 1.0F) give_back_what_layers_lose();
}

void PrincipledBsdf::give_back_what_layers_lose() {
  Spread beneath = spread_beneath();
  const Rgb all = beneath.back() + beneath.through();
  beneath.wide = beneath.wide_through = Rgb(0.0F);  // of the matt part nothing is lost
  beneath.lobe -= parts_.facet_tint * (plain_ * (1.0F - interface_.mean_rest(parts_.alpha)));
  const LayerLight light(*layer_loss_, beneath, all);
  if (!light.is_none()) layer_light_.emplace(light);
}

/// Of what lies beneath coat and fuzz.
Spread PrincipledBsdf::spread_beneath() const {
  Spread all{.alpha = parts_.alpha};
  const float rest = interface_.mean_rest(parts_.alpha);
  all.wide = parts_.matt * (plain_ * rest);
  all.wide_through = parts_.matt_through * (plain_ * rest);
  if (mirrors()) return all;
  all.lobe = parts_.facet_tint * (plain_ * (1.0F - rest));
  if (parts_.metallic > 0.0F) {
    const float kept = parts_.metal_keeps_light ? 1.0F : 1.0F - white_.mean_loss();
    all.lobe += parts_.metallic * kept * mean_metal_reflectance();
  }
  if (parts_.glass != nullptr)
    all.add(parts_.glass->spread(1.0F), Rgb((1.0F - parts_.metallic) * parts_.glassy));
  return all;
}

Spread PrincipledBsdf::spread(float outer) const {
  Spread all;
  const Vec3 w(0.0F, 0.0F, outer);
  float beneath = 1.0F;
  if (layered(w)) {
    if (parts_.fuzz) {
      all.add(parts_.fuzz->spread(), Rgb(1.0F));
      beneath *= 1.0F - parts_.fuzz->mean_share();
    }
    if (parts_.coat) {
      all.add(parts_.coat->spread(), Rgb(beneath));
      beneath *= 1.0F - parts_.coat->mean_share();
    }
  }
  all.add(spread_beneath(), Rgb(beneath));
  return all;
}

/// What gets to the matt part of light from `w`: what neither the layers nor the facets over it
/// reflect, and what the layers throw down of what these facets do.
float PrincipledBsdf::rest(const Layers& layers, const Vec3& w) const {
  const float share = facet_share(w);
  const float rest = layers.beneath * (1.0F - share);
  return layer_loss_ && layers.beneath < 1.0F ? rest + share * layer_loss_->of_lobe(w.z) : rest;
}

const LayerLight* PrincipledBsdf::lost_light(const Vec3& w) const {
  return layer_light_ && layered(w) ? &*layer_light_ : nullptr;
}

PrincipledBsdf::Layers PrincipledBsdf::layers_of(const Vec3& w) const {
  Layers layers;
  if (!layered(w)) return layers;
  const Vec3 up = above(w);
  if (parts_.fuzz) layers.fuzz = parts_.fuzz->share(up);
  if (parts_.coat) layers.coat = parts_.coat->share(up);
  layers.beneath = (1.0F - layers.fuzz) * (1.0F - layers.coat);
  return layers;
}

float PrincipledBsdf::facet_share(const Vec3& o) const {
  if (!stretched()) return interface_.reflected(o.z, parts_.alpha);
  const float root = (parts_.eta - 1.0F) / (parts_.eta + 1.0F);
  const float even = interface_.reflected(o.z, parts_.facets.seen_from(o));
  return std::fmin(even * white_.over_even(o, root * root), 1.0F);
}

/// The mean over the hemisphere of what gets to the matt part, weighed with the cosine.
float PrincipledBsdf::mean_rest(bool covered) const {
  const bool layers = covered && (parts_.coat.has_value() || parts_.fuzz.has_value());
  if (!layers && !stretched()) return interface_.mean_rest(parts_.alpha);
  const auto rest_at = [&](const Vec3& w) { return rest(layers ? layers_of(w) : Layers(), w); };
  return hemisphere_mean([&](float cosine) {
    const float sine = std::sqrt(1.0F - cosine * cosine);
    if (!stretched()) return rest_at({0.0F, sine, cosine});
    // 15, 45 and 75 degrees: exact for waves of up to ten a turn.
    constexpr float kTurns[3][2] = {
        {0.9659258F, 0.2588190F}, {0.7071068F, 0.7071068F}, {0.2588190F, 0.9659258F}};
    float sum = 0.0F;
    for (const auto& [x, y] : kTurns) sum += rest_at({sine * x, sine * y, cosine});
    return sum / 3.0F;
  });
}

/// Schlick's formula (1994), bent down at the edge.
Rgb PrincipledBsdf::metal_reflectance(float cosine) const {
  const float fall = 1.0F - cosine;
  const float steep = fifth_power(fall);
  const Rgb f =
      parts_.metal + (Rgb(1.0F) - parts_.metal) * steep - metal_bend_ * (cosine * steep * fall);
  return glm::clamp(f, Rgb(0.0F), Rgb(1.0F));
}

/// The mean of metal_reflectance() over the hemisphere, weighed with the cosine: 2 integral of (1 -
/// mu)^5 mu is 1/21, of mu (1 - mu)^6 mu 1/126.
Rgb PrincipledBsdf::mean_metal_reflectance() const {
  const Rgb f = parts_.metal + (Rgb(1.0F) - parts_.metal) / 21.0F - metal_bend_ / 126.0F;
  return glm::clamp(f, Rgb(0.0F), Rgb(1.0F));
}

/// What facets reflect, the metal's and those over the matt part, by their shares.
Rgb PrincipledBsdf::facet_color(float cosine) const {
  Rgb color(0.0F);
  if (parts_.metallic > 0.0F) color += parts_.metallic * metal_reflectance(cosine);
  if (plain_ > 0.0F) {
    color += parts_.facet_tint * (plain_ * fresnel_dielectric(cosine, parts_.eta).reflectance);
  }
  return color;
}

float PrincipledBsdf::matt_value(const Layers& to, const Layers& from, const Vec3& o,
                                 const Vec3& i) const {
  return plain_ * rest(to, above(o)) * rest(from, above(i)) *
         (layered(o) ? matt_scale_ : bare_scale_) * std::fabs(i.z);
}

float PrincipledBsdf::metal_loss(const Vec3& o) const {
  if (lost_scale_ == 0.0F) return 0.0F;
  return 1.0F - white_.reflectance(o);
}

float PrincipledBsdf::lost_value(const Vec3& o, const Vec3& i) const {
  if (lost_scale_ == 0.0F) return 0.0F;
  return metal_loss(o) * metal_loss(i) * i.z * lost_scale_;
}

Rgb PrincipledBsdf::evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  if (wo.z == 0.0F || wi.z == 0.0F) return Rgb(0.0F);
  const Layers to = layers_of(wo);
  const Layers from = layers_of(wi);
  const float least = std::fmin(to.beneath, from.beneath);
  Rgb value(0.0F);
  if (parts_.glass != nullptr)
    value +=
        parts_.glass->evaluate(wo, wi, mode) * ((1.0F - parts_.metallic) * parts_.glassy * least);
  if (const LayerLight* lost = lost_light(wo))
    value += lost->value(std::fabs(wo.z), std::fabs(wi.z), !same_side(wo, wi)) * std::fabs(wi.z);
  if (!same_side(wo, wi)) {
    return plain_ > 0.0F ? value + parts_.matt_through * matt_value(to, from, wo, wi) : value;
  }
  const Vec3 o = above(wo);
  const Vec3 i = above(wi);
  if (plain_ > 0.0F) value += parts_.matt * matt_value(to, from, wo, wi);
  if (parts_.metallic > 0.0F) value += lost_tint_ * (parts_.metallic * least * lost_value(o, i));
  if (!mirrors()) {
    const float facets = parts_.facets.reflect(o, i);
    if (facets > 0.0F) {
      const Vec3 h = o + i;
      const float cosine = std::fmin(1.0F, glm::dot(o, h) / glm::length(h));
      value += facet_color(cosine) * (facets * least);
    }
  }
  if (!layered(wo)) return value;
  if (parts_.coat) value += parts_.coat->reflect(o, i) * (1.0F - std::fmax(to.fuzz, from.fuzz));
  if (parts_.fuzz) value += parts_.fuzz->reflect(o, i);
  return value;
}

Rgb PrincipledBsdf::evaluate_diffuse(const Vec3& wo, const Vec3& wi) const {
  if (!(plain_ > 0.0F) || !same_side(wo, wi)) return Rgb(0.0F);
  return parts_.matt * matt_value(layers_of(wo), layers_of(wi), wo, wi);
}

PrincipledBsdf::Lobes PrincipledBsdf::lobes_of(const Vec3& wo, const Layers& layers) const {
  const Vec3 o = above(wo);
  Lobes p;
  p.fuzz = layers.fuzz;
  p.coat = layers.coat * (1.0F - layers.fuzz);
  const float beneath = layers.beneath;
  if (plain_ > 0.0F) {
    const float share = facet_share(o);
    p.facets += plain_ * share * beneath * max_component(parts_.facet_tint);
    const float matt = plain_ * rest(layers, o);
    p.cosine += matt * max_component(parts_.matt);
    p.through += matt * max_component(parts_.matt_through);
  }
  if (parts_.metallic > 0.0F) {
    const float loss = metal_loss(o);
    const float metal = parts_.metallic * beneath;
    p.facets += metal * (1.0F - loss) * max_component(metal_reflectance(o.z));
    p.cosine += metal * loss * max_component(lost_tint_);
  }
  if (const LayerLight* lost = lost_light(wo)) {
    const float part = max_component(lost->part(o.z));
    p.cosine += part * (1.0F - lost->through_share());
    p.through += part * lost->through_share();
  }
  if (parts_.glass != nullptr) p.glass = (1.0F - parts_.metallic) * parts_.glassy * beneath;
  const float all = p.fuzz + p.coat + p.facets + p.cosine + p.through + p.glass;
  if (!(all > 0.0F)) return {};
  for (float* each : {&p.fuzz, &p.coat, &p.facets, &p.cosine, &p.through, &p.glass}) *each /= all;
  return p;
}

float PrincipledBsdf::pdf(const Lobes& p, const Vec3& wo, const Vec3& wi,
                          TransportMode mode) const {
  if (wo.z == 0.0F || wi.z == 0.0F) return 0.0F;
  float density = p.glass > 0.0F ? p.glass * parts_.glass->pdf(wo, wi, mode) : 0.0F;
  const float even = cosine_hemisphere_pdf(std::fabs(wi.z));
  if (!same_side(wo, wi)) return density + p.through * even;
  const Vec3 o = above(wo);
  const Vec3 i = above(wi);
  density += p.cosine * even;
  if (p.facets > 0.0F && !mirrors()) density += p.facets * parts_.facets.reflect_pdf(o, i);
  if (p.coat > 0.0F) density += p.coat * parts_.coat->pdf(o, i);
  if (p.fuzz > 0.0F) density += p.fuzz * parts_.fuzz->pdf(o, i);
  return density;
}

float PrincipledBsdf::pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  return pdf(lobes_of(wo, layers_of(wo)), wo, wi, mode);
}

std::optional<BsdfSample> PrincipledBsdf::mirrored_sample(const Vec3& wo, const Rgb& value,
                                                          float probability) const {
  return BsdfSample{
      .weight = value / probability, .pdf = probability, .wi = mirrored(wo), .delta = true};
}

std::optional<BsdfSample> PrincipledBsdf::sample(const Vec3& wo, float lobe, const Vec2& u,
                                                 TransportMode mode) const {
  const Vec3 o = above(wo);
  if (!(o.z > 0.0F)) return std::nullopt;
  const Layers layers = layers_of(wo);
  const Lobes p = lobes_of(wo, layers);
  BsdfSample s;
  Vec3 i;
  float begin = 0.0F;
  const auto falls_into = [&](float width) {
    if (width > 0.0F && lobe < begin + width) return true;
    begin += width;
    return false;
  };
  if (falls_into(p.cosine)) {
    i = square_to_cosine_hemisphere(u);
  } else if (falls_into(p.facets)) {
    if (mirrors()) return mirrored_sample(wo, facet_color(o.z) * layers.beneath, p.facets);
    i = reflected(o, parts_.facets.sample_normal(o, u));
  } else if (falls_into(p.coat)) {
    if (parts_.coat->is_mirror())
      return mirrored_sample(wo, parts_.coat->mirror(o) * (1.0F - layers.fuzz), p.coat);
    i = parts_.coat->draw(o, u);
  } else if (falls_into(p.fuzz)) {
    i = parts_.fuzz->draw(o, u);
  } else if (falls_into(p.through)) {
    i = square_to_cosine_hemisphere(u);
    s.transmitted = true;
  } else if (p.glass > 0.0F) {
    auto drawn = parts_.glass->sample(wo, rest_of(lobe, begin, p.glass), u, mode);
    if (!drawn) return std::nullopt;
    if (drawn->delta) {
      const float least = std::fmin(layers.beneath, layers_of(drawn->wi).beneath);
      drawn->weight *= (1.0F - parts_.metallic) * parts_.glassy * least / p.glass;
      drawn->pdf *= p.glass;
      return drawn;
    }
    s = *drawn;
    i = above(s.wi);
  } else {
    return std::nullopt;
  }
  if (!(i.z > 0.0F)) return std::nullopt;
  s.wi = {i.x, i.y, s.transmitted ? -i.z * side(wo) : i.z * side(wo)};
  s.pdf = pdf(p, wo, s.wi, mode);
  if (!(s.pdf > 0.0F)) return std::nullopt;
  s.weight = evaluate(wo, s.wi, mode) / s.pdf;
  return s;
}

Rgb PrincipledBsdf::albedo(const Vec3& wo) const {
  const Vec3 o = above(wo);
  const Layers layers = layers_of(wo);
  Rgb beneath(0.0F);
  if (plain_ > 0.0F) {
    const float share = facet_share(o);
    beneath +=
        plain_ * (parts_.facet_tint * share + (parts_.matt + parts_.matt_through) * (1.0F - share));
  }
  if (parts_.metallic > 0.0F) beneath += parts_.metallic * metal_reflectance(o.z);
  if (parts_.glass != nullptr)
    beneath += (1.0F - parts_.metallic) * parts_.glassy * parts_.glass->albedo(wo);
  return beneath * layers.beneath + Rgb(1.0F - layers.beneath);
}

bool PrincipledBsdf::has_smooth() const {
  if (parts_.fuzz || (parts_.coat && !parts_.coat->is_mirror())) return true;
  if (!mirrors() && (plain_ > 0.0F || parts_.metallic > 0.0F)) return true;
  if (plain_ > 0.0F && !is_black(parts_.matt + parts_.matt_through)) return true;
  return parts_.glass != nullptr && parts_.glass->has_smooth();
}

}  // namespace hyades::core
