#include "core/integrators/light_parts.h"

#include <algorithm>
#include <cstddef>

namespace hyades::core {
namespace {

/// `direct`, or the indirect one that stands beside it.
LightComponent scattered(LightComponent direct, int events) {
  return events == 1 ? direct : static_cast<LightComponent>(static_cast<int>(direct) + 1);
}

/// The part of the group of `source`, or -1.
int group_of(const PartTable& table, const LightSource& source) {
  if (source.index != LightSource::kMedium) return table.lights[source.index];
  for (const auto& [medium, part] : table.media) {
    if (medium == source.medium) return part;
  }
  return table.rest;
}

}  // namespace

FirstEvent FirstEvent::at(const ShadedSurface& surface, const Vec3& wo, const Vec3& wi,
                          bool specular) {
  const Vec3& ng = surface.point().ng;
  if (glm::dot(wo, ng) * glm::dot(wi, ng) < 0.0F) return {Kind::transmission};
  return {Kind::reflection, specular ? Rgb(0.0F) : surface.diffuse_share(wo, wi)};
}

Rgb FirstEvent::keep(RayKind kinds) {
  if (kind == Kind::volume) return Rgb(meet(kinds, RayKind::volume) ? 1.0F : 0.0F);
  if (kind == Kind::transmission) return Rgb(meet(kinds, RayKind::transmission) ? 1.0F : 0.0F);
  const bool glossy = meet(kinds, RayKind::glossy);
  if (glossy && meet(kinds, RayKind::diffuse)) return Rgb(1.0F);
  const Rgb kept = glossy                          ? Rgb(1.0F) - diffuse
                   : meet(kinds, RayKind::diffuse) ? diffuse
                                                   : Rgb(0.0F);
  diffuse = Rgb(glossy ? 0.0F : 1.0F);
  return kept;
}

void LightParts::clear() {
  std::fill(sums_.begin(), sums_.end(), Rgb(0.0F));
  splat_parts_.clear();
}

template <class Take>
void LightParts::split(const FirstEvent& first, int events, const LightSource& source,
                       const Rgb& light, const Take& take) const {
  const auto to = [&](LightComponent component, const Rgb& value) {
    const int part = table_.components[static_cast<size_t>(component)];
    if (part >= 0 && !is_black(value)) take(static_cast<uint32_t>(part), value);
  };
  if (events == 0) {
    to(source.infinitely_far ? LightComponent::environment : LightComponent::emission, light);
  } else if (first.kind == FirstEvent::Kind::volume) {
    to(scattered(LightComponent::volume_direct, events), light);
  } else if (first.kind == FirstEvent::Kind::transmission) {
    to(scattered(LightComponent::transmission_direct, events), light);
  } else {
    const Rgb diffuse = first.diffuse * light;
    to(scattered(LightComponent::diffuse_direct, events), diffuse);
    to(scattered(LightComponent::glossy_direct, events), light - diffuse);
  }
  const int group = group_of(table_, source);
  if (group >= 0 && !is_black(light)) take(static_cast<uint32_t>(group), light);
}

void LightParts::add(const FirstEvent& first, int events, const LightSource& source,
                     const Rgb& light) {
  split(first, events, source, light,
        [&](uint32_t part, const Rgb& value) { sums_[part] += value; });
}

void LightParts::add_splat(const FirstEvent& first, int events, const LightSource& source,
                           const Rgb& light) {
  split(first, events, source, light, [&](uint32_t part, const Rgb& value) {
    splat_parts_.push_back({part, value});
  });
}

}  // namespace hyades::core
