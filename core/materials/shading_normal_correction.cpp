#include "core/materials/shading_normal_correction.h"

#include <cstdlib>

namespace hyades::core {

float ShadingNormalCorrection::pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi,
                                   TransportMode mode) const {
  const bool radiance = mode == TransportMode::radiance;
  // One of the two arguments has sources, the other is looked from.
  const Vec3& looking = radiance ? wo : wi;
  const Cosines eye(*this, looking);
  const Vec3 from = seen(looking, eye);
  const Sources sources = sources_of(radiance ? wi : wo);
  float sum = 0.0F;
  float cosines = 0.0F;
  for (int n = 0; n < sources.count; ++n) {
    const Vec3 source = frame_.to_local(sources.direction[n]);
    sum +=
        radiance ? bsdf.pdf(from, source, mode) : sources.cosine[n] * bsdf.pdf(source, from, mode);
    cosines += sources.cosine[n];
  }
  if (radiance) return sum;
  return cosines > 0.0F ? sum / (cosines * onlookers(eye)) : 0.0F;
}

std::optional<BsdfSample> ShadingNormalCorrection::sample(const Bsdf& bsdf, const Vec3& wo,
                                                          float lobe, const Vec2& u,
                                                          TransportMode mode) const {
  return mode == TransportMode::radiance ? sample_radiance(bsdf, wo, lobe, u)
                                         : sample_importance(bsdf, wo, lobe, u);
}

std::optional<BsdfSample> ShadingNormalCorrection::weighed(const Bsdf& bsdf, const Vec3& wo,
                                                           BsdfSample sample,
                                                           TransportMode mode) const {
  sample.pdf = pdf(bsdf, wo, sample.wi, mode);
  if (!(sample.pdf > 0.0F)) return std::nullopt;
  sample.weight = evaluate(bsdf, wo, sample.wi, mode) / sample.pdf;
  return sample;
}

std::optional<BsdfSample> ShadingNormalCorrection::sample_radiance(const Bsdf& bsdf, const Vec3& wo,
                                                                   float lobe,
                                                                   const Vec2& u) const {
  const Vec3 o = seen(wo, Cosines(*this, wo));
  auto s = bsdf.sample(o, lobe, u, TransportMode::radiance);
  if (!s) return std::nullopt;
  s->wi = glm::normalize(frame_.to_world(s->wi));
  Cosines c(*this, s->wi);
  const bool above = c.agree();
  if (!above) {
    if (!folded(Cosines(*this, below(s->wi, c)))) return std::nullopt;
    s->wi = below(s->wi, c);
    c = Cosines(*this, s->wi);
  }
  const bool alone = above ? !folded(c) : !c.agree();
  if (s->delta || alone) return s;
  return weighed(bsdf, wo, *s, TransportMode::radiance);
}

std::optional<BsdfSample> ShadingNormalCorrection::sample_importance(const Bsdf& bsdf,
                                                                     const Vec3& wo, float lobe,
                                                                     const Vec2& u) const {
  const Sources sources = sources_of(wo);
  if (sources.count == 0) return std::nullopt;
  int n = 0;
  float p = 1.0F;
  if (sources.count == 2) {
    const float first = sources.cosine[0] / (sources.cosine[0] + sources.cosine[1]);
    n = lobe < first ? 0 : 1;
    p = n == 0 ? first : 1.0F - first;
    lobe = rest_of(lobe, n == 0 ? 0.0F : first, p);
  }
  // To one of two onlookers, should there be two.
  const bool to_mirror = leans_ && lobe < 0.5F;
  if (leans_) lobe = rest_of(lobe, to_mirror ? 0.0F : 0.5F, 0.5F);
  const Vec3 o = frame_.to_local(sources.direction[n]);
  auto s = bsdf.sample(o, lobe, u, TransportMode::importance);
  if (!s) return std::nullopt;
  s->wi = glm::normalize(frame_.to_world(s->wi));
  const Cosines in(*this, s->wi);
  if (!in.agree()) return std::nullopt;  // nobody looks from below the surface
  const float onlookers_there = onlookers(in);
  if (onlookers_there > 1.0F && to_mirror) s->wi = behind(s->wi);
  p /= onlookers_there;
  if (!s->delta && p < 1.0F) return weighed(bsdf, wo, *s, TransportMode::importance);
  const float under = std::abs(glm::dot(wo, ng_) * in.bsdf) * p;
  if (!(under > 0.0F)) return std::nullopt;
  s->weight *= sources.cosine[n] * std::abs(in.surface) / under;
  s->pdf *= p;
  return s;
}

}  // namespace hyades::core
