#include "core/integrators/random_walk.h"

#include <algorithm>
#include <cstdint>

#include "core/integrators/visibility.h"
#include "core/media/shares.h"

namespace hyades::core {
namespace {

/// Russian roulette: false where a path that still carries the part `left` of what it began with
/// ends, decided by `u` in [0, 1); else `throughput` makes up for those that do. `left` is without
/// the factor of refraction, which is undone when the path leaves the glass again. What still
/// carries half goes on for certain: with survival in proportion to `left` itself, variance times
/// rays is 2.7 times as high for a dragon of glass under a sky, and within a tenth in rooms.
bool survives_roulette(float left, float u, Rgb& throughput) {
  constexpr float kEnough = 0.5F;
  constexpr float kLeast = 0.05F;  // a path that survives less often would be all noise
  const float keep = std::max(left / kEnough, kLeast);
  if (keep >= 1.0F) return true;
  if (u >= keep) return false;
  throughput /= keep;
  return true;
}

}  // namespace

RandomWalk::RandomWalk(const IntegratorDesc& settings, const Scene& scene, Sampler& sampler,
                       Workspace& work, const WalkKind& kind, const PathSegment& start,
                       WalkWatcher& watcher)
    : settings_(settings),
      scene_(scene),
      sampler_(sampler),
      work_(work),
      kind_(kind),
      watcher_(watcher),
      segment_(start),
      start_(std::max(max_component(start.throughput), 1e-30F)) {}

bool RandomWalk::next(ScatteringPlace& place) {
  MediaNumbers numbers(sampler_, events_, kind_.flights);
  MediaNumbers passing(sampler_, events_, kind_.passing);
  const RayKind ray_kind = segment_.kind;
  Ray& ray = segment_.ray;
  SurfacePoint& point = place.point;
  for (int crossings = 0; crossings <= kMaxNullCrossings; ++crossings) {
    ++work_.rays;
    point = {};
    const bool met = scene_.world->nearest(ray, ray_kind, point);
    if (const Medium* medium = segment_.around.medium(); medium != nullptr) {
      const bool held_out = is_held_out(segment_.around.body());
      const Flight flight = fly(*medium, met ? &point : nullptr, numbers, place, held_out);
      if (flight != Flight::passed) return flight == Flight::scattered && !held_out;
    }
    if (!met) {
      watcher_.leaves(segment_);
      return false;
    }
    const SceneObject& object = scene_.objects[point.object];
    const bool unseen = is_unseen(object, point, ray.direction, ray_kind);
    const bool passed = unseen || goes_straight(object, point, segment_.around, passing);
    const bool held_out = object.holdout && ray_kind == RayKind::camera;
    if (!unseen && !held_out) watcher_.meets(segment_, point, object, passed);
    if (held_out && !passed) {
      watcher_.meets_holdout(object);
      return false;
    }
    if (!passed) {
      point.outside_index = segment_.around.index_outside(object.body);
      place.object = &object;
      place.position = point.position;
      return true;
    }
    cross(object, point, ray.direction, segment_.around);
    ray = spawn_ray(point, ray.direction);
  }
  return false;
}

/// Whether the ray is the camera's and `body`, whose medium it goes through (may be null), a
/// holdout.
bool RandomWalk::is_held_out(const Body* body) const {
  return segment_.kind == RayKind::camera && body != nullptr &&
         scene_.objects[body->object].holdout;
}

/// Goes through `medium` to `surface` (null: to infinity), or to where it scatters. `held_out`: its
/// light is not wanted.
RandomWalk::Flight RandomWalk::fly(const Medium& medium, const SurfacePoint* surface,
                                   MediaNumbers& numbers, ScatteringPlace& place, bool held_out) {
  const Ray& ray = segment_.ray;
  const float t_max = surface != nullptr ? surface->t : kInfinity;
  const Vec4 u = numbers.next();
  if (kind_.mode == TransportMode::radiance && !held_out) {
    const Rgb emitted = medium.emitted(ray, t_max, u);
    if (!is_black(emitted)) watcher_.medium_emits(segment_, emitted);
  }
  place.flight = {ray, t_max, &medium, channel_shares(segment_.throughput), segment_.around.open()};
  if (!held_out) watcher_.flies(place.flight, surface, numbers);
  const MediumSample sample = medium.sample(ray, t_max, place.flight.shares, u);
  segment_.throughput *= sample.weight;
  if (is_black(segment_.throughput)) return Flight::absorbed;
  if (!sample.scattered) return Flight::passed;
  place.object = nullptr;
  place.t = sample.t;
  place.position = place_in_medium(ray, sample.t, surface);
  return Flight::scattered;
}

std::optional<BsdfSample> RandomWalk::scatter(const ShadedSurface& surface,
                                              const SceneObject& object, const Vec3& wo) {
  const Vec4 u = event_numbers();
  if (surface.bsdf() == nullptr) return std::nullopt;
  const auto sample = surface.sample(wo, u.z, Vec2(u), kind_.mode);
  if (!sample || is_black(sample->weight)) return std::nullopt;
  segment_.throughput *= sample->weight;
  segment_.specular = sample->delta;
  segment_.pdf = sample->delta ? 1.0 : static_cast<double>(sample->pdf);
  segment_.pdf_across = 0.0;
  if (is_scaled(kind_.mode, sample->scale_radiance)) eta_scale_ *= sample->eta * sample->eta;
  segment_.kind = scene_.tells_rays_apart ? choose_kind(surface, wo, *sample) : RayKind::diffuse;
  if (!survives(u.w)) return std::nullopt;
  const SurfacePoint& point = surface.point();
  if (glm::dot(wo, point.ng) * glm::dot(sample->wi, point.ng) < 0.0F)
    cross(object, point, sample->wi, segment_.around);
  keep_seen(scene_, segment_.kind, segment_.around);
  segment_.ray = spawn_ray(point, sample->wi);
  return sample;
}

bool RandomWalk::scatter(const Medium& medium, const Vec3& position) {
  const Vec4 u = event_numbers();
  const Phase& phase = medium.phase();
  const Rgb shares = channel_shares(segment_.throughput);
  const Ray& ray = segment_.ray;
  const Vec3 direction = phase.sample(ray.direction, shares, u.z, Vec2(u));
  const float cosine = glm::dot(ray.direction, direction);
  const float pdf = phase.pdf(cosine, shares);
  if (!(pdf > 0.0F)) return false;
  segment_.throughput *= phase.evaluate(cosine) / pdf;
  segment_.specular = false;
  segment_.pdf = static_cast<double>(pdf);
  segment_.pdf_across = 0.0;
  segment_.kind = RayKind::volume;
  keep_seen(scene_, segment_.kind, segment_.around);
  segment_.ray = {position, direction, kInfinity, ray.time};
  return survives(u.w);
}

/// The kind of the ray that goes on along `sample`, away from `wo`. What is reflected partly by the
/// diffuse part of a surface is either, in proportion, and the throughput makes up for what of each
/// channel is not: so what either meets brings on average what it brings to its part.
RayKind RandomWalk::choose_kind(const ShadedSurface& surface, const Vec3& wo,
                                const BsdfSample& sample) {
  if (sample.transmitted) return RayKind::transmission;
  if (sample.delta) return RayKind::glossy;
  const Rgb diffuse = surface.diffuse_share(wo, sample.wi);
  const Rgb shares = channel_shares(segment_.throughput);
  const float probability = glm::dot(shares, diffuse);
  const float u = MediaNumbers(sampler_, events_, kind_.passing).kind_number();
  if (u < probability) {
    segment_.throughput *= diffuse / probability;
    return RayKind::diffuse;
  }
  if (probability < 1.0F) segment_.throughput *= (Rgb(1.0F) - diffuse) / (1.0F - probability);
  return RayKind::glossy;
}

/// For direction (x, y), lobe (z) and roulette (w) of the next scattering event.
Vec4 RandomWalk::event_numbers() {
  sampler_.set_dimension(kind_.first + static_cast<uint32_t>(events_) * kind_.per_event);
  return sampler_.next_4d();
}

/// Counts one more scattering event; false where roulette, decided by `u`, ends the walk.
bool RandomWalk::survives(float u) {
  ++work_.bounces;
  ++events_;
  if (events_ < settings_.roulette_depth) return true;
  const float left = max_component(segment_.throughput) / start_ * eta_scale_;
  if (survives_roulette(left, u, segment_.throughput)) return true;
  watcher_.loses_roulette();
  return false;
}

}  // namespace hyades::core
