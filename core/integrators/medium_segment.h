#pragma once

#include <cmath>
#include <optional>

#include "core/lights/light.h"
#include "core/media/equiangular.h"
#include "core/media/medium.h"

namespace hyades::core {

/// The point of `ray` at `t`, but clear of the surface behind it (null: none): rounding must not
/// put it on the other side, where a path would never meet that surface again.
inline Vec3 place_in_medium(const Ray& ray, float t, const SurfacePoint* surface) {
  if (surface != nullptr) {
    const float height = (surface->t - t) * std::abs(glm::dot(ray.direction, surface->ng));
    if (height < surface->clearance) return offset_position(*surface, -ray.direction);
  }
  return ray.at(t);
}

/// The part of a path that leads through a medium, on which it looks for a place to scatter.
struct MediumSegment {
  Ray ray;
  float t_max = 0.0F;
  const Medium* medium = nullptr;  ///< null: the path was not in a medium
  Rgb shares{1.0F / 3.0F};         ///< with which free flight chooses channels
  bool open = false;               ///< MediumStack::open

  /// Where to look for places besides free flight: near `light`, in media that are the same
  /// everywhere, where the light may come in straight and is not all but swallowed on the way from
  /// there. Nothing where that does not pay. Depends on nothing but the segment and the light.
  std::optional<Equiangular> places_near(const Light& light) const {
    if (medium == nullptr || !open || !medium->flight_density(0.0F, shares)) return std::nullopt;
    const std::optional<Vec3> middle = light.middle();
    if (!middle) return std::nullopt;
    const Equiangular places(ray, t_max, *middle);
    // Seen under less the places are all but even, and the angle's rounding would show.
    constexpr float kLeastAngle = 1e-3F;
    if (!(places.angle() > kLeastAngle)) return std::nullopt;
    constexpr float kLeastShare = 0.02F;
    const Rgb passed = medium->transmittance(ray, places.nearest(), Vec4(0.5F));
    return max_component(passed) > kLeastShare ? std::optional(places) : std::nullopt;
  }

  /// The density of places_near(light) at `t` over that of free flight, `pdf`.
  float rival(const Light& light, float t, float pdf) const {
    const std::optional<Equiangular> places = places_near(light);
    return places && pdf > 0.0F ? places->pdf(t) / pdf : 0.0F;
  }
};

}  // namespace hyades::core
