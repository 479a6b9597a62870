#include "core/integrators/random_walk.h"

#include <algorithm>
#include <cmath>

#include "core/integrators/medium_way.h"
#include "core/integrators/roulette.h"
#include "core/integrators/visibility.h"
#include "core/media/shares.h"

namespace hyades::core {
namespace {

TransportMode other(TransportMode mode) {
  return mode == TransportMode::radiance ? TransportMode::importance : TransportMode::radiance;
}

/// Solid angle on the side of wi over that on the side of wo, which refraction presses together or
/// apart: n^2 cos dw is the same on both sides.
double solid_angle_ratio(const ShadedSurface& surface, const Vec3& wo, const BsdfSample& sample) {
  if (!sample.transmitted) return 1.0;
  const auto cosine = [&](const Vec3& w) {
    return std::max(static_cast<double>(std::abs(glm::dot(w, surface.frame().n))), 1e-6);
  };
  const double eta = static_cast<double>(sample.eta);
  return cosine(wo) / (eta * eta * cosine(sample.wi));
}

}  // namespace

double Way::density_at(const PathVertex& v, const Vec3& from) const {
  if (pdf_across > 0.0) return pdf_across * v.across(ray.direction);
  return pdf * v.per_direction(from, ray.direction);
}

void RandomWalk::go(Subpath& path, Way way, int most, WalkWatcher& watcher) {
  events_ = 0;
  eta_scale_ = 1.0F;
  start_ = std::max(max_component(way.throughput), 1e-30F);
  while (path.size() < most) {
    PathVertex* const vertex = next_vertex(path, way, watcher);
    if (vertex == nullptr) return;
    watcher.arrives(*vertex);
    if (path.size() >= most || !scatter(path, way)) return;
    watcher.goes_on(*vertex, way);
  }
}

/// The next place where light scatters; null where there is none.
PathVertex* RandomWalk::next_vertex(Subpath& path, Way& way, WalkWatcher& watcher) {
  MediaNumbers numbers(sampler_, events_, numbers_.flights);
  MediaNumbers passing(sampler_, events_, numbers_.passing);
  const RayKind kind =
      events_ == 0 && mode_ == TransportMode::radiance ? RayKind::camera : RayKind::other;
  for (int crossings = 0; crossings <= kMaxNullCrossings; ++crossings) {
    ++work_.rays;
    SurfacePoint point;
    const bool met = scene_.world->nearest(way.ray, kind, point);
    if (const Medium* medium = way.around.medium(); medium != nullptr) {
      const float t_max = met ? point.t : kInfinity;
      const Vec4 u = numbers.next();
      if (mode_ == TransportMode::radiance) {
        const Rgb emitted = medium->emitted(way.ray, t_max, u);
        if (!is_black(emitted)) watcher.medium_emits(way, emitted);
      }
      const MediumSample sample = medium->sample(way.ray, t_max, channel_shares(way.throughput), u);
      way.throughput *= sample.weight;
      if (is_black(way.throughput)) return nullptr;
      if (sample.scattered) {
        PathVertex& v = path.add(PathVertex::Kind::medium);
        v.medium = medium;
        v.position = place_in_medium(way.ray, sample.t, met ? &point : nullptr);
        connect_to_last(path, way, v);
        return &v;
      }
    }
    if (!met) {
      watcher.leaves(way);
      return nullptr;
    }
    const SceneObject& object = scene_.objects[point.object];
    const bool unseen = is_unseen(object, point, way.ray.direction, kind);
    if (!unseen) watcher.meets(way, point, object);
    if (!unseen && !goes_straight(object, point, way.around, passing)) {
      PathVertex& v = path.add(PathVertex::Kind::surface);
      v.point = point;
      v.point.outside_index = way.around.index_outside(object.body);
      v.position = point.position;
      v.object = &object;
      v.surface.emplace(v.point, *object.material, path.arena());
      connect_to_last(path, way, v);
      return &v;
    }
    cross(object, point, way.ray.direction, way.around);
    const float time = way.ray.time;
    way.ray = spawn_ray(point, way.ray.direction);
    way.ray.time = time;
  }
  return nullptr;
}

/// What `v`, the newest vertex, has from the way that led there.
void RandomWalk::connect_to_last(Subpath& path, const Way& way, PathVertex& v) const {
  const PathVertex& before = path[path.size() - 2];
  v.wo = -way.ray.direction;
  v.throughput = way.throughput;
  v.around = way.around;
  v.density = way.density_at(v, before.position);
  v.edge = way.specular ? 0.0 : 1.0;
  v.beyond = before.chain / (before.density * before.density);
}

/// Chooses the way on from the last vertex; false where the walk ends.
bool RandomWalk::scatter(Subpath& path, Way& way) {
  PathVertex& v = path.back();
  sampler_.set_dimension(numbers_.first + static_cast<uint32_t>(events_) * numbers_.per_event);
  const Vec4 u = sampler_.next_4d();
  const float time = way.ray.time;
  double backward = 0.0;  // density per solid angle of the direction to the vertex before
  if (v.kind == PathVertex::Kind::surface) {
    if (v.surface->bsdf() == nullptr) return false;
    const auto sample = v.surface->sample(v.wo, u.z, Vec2(u), mode_);
    if (!sample || is_black(sample->weight)) return false;
    way.throughput *= sample->weight;
    way.specular = sample->delta;
    if (mode_ == TransportMode::radiance) eta_scale_ *= sample->eta * sample->eta;
    if (sample->delta) {
      way.pdf = 1.0;
      backward = solid_angle_ratio(*v.surface, v.wo, *sample);
    } else {
      way.pdf = static_cast<double>(sample->pdf);
      backward = v.pdf(sample->wi, v.wo, other(mode_));
    }
    way.around = v.around_towards(sample->wi);
    way.ray = spawn_ray(v.point, sample->wi);
  } else {
    const Phase& phase = v.medium->phase();
    const Rgb shares = channel_shares(way.throughput);
    const Vec3 direction = phase.sample(-v.wo, shares, u.z, Vec2(u));
    const float cosine = glm::dot(-v.wo, direction);
    const float pdf = phase.pdf(cosine, shares);
    if (!(pdf > 0.0F)) return false;
    way.throughput *= phase.evaluate(cosine) / pdf;
    way.specular = false;
    way.pdf = v.pdf(v.wo, direction, mode_);
    backward = v.pdf(direction, v.wo, other(mode_));
    way.around = v.around;
    way.ray = {v.position, direction};
  }
  way.ray.time = time;
  way.pdf_across = 0.0;
  const double reverse = backward * path[path.size() - 2].per_direction(v.position, v.wo);
  v.chain = (way.specular ? 0.0 : v.edge) + v.beyond * reverse * reverse;
  return survives(way, u.w);
}

/// One more scattering event; false where roulette, decided by `u`, ends the walk.
bool RandomWalk::survives(Way& way, float u) {
  ++work_.bounces;
  ++events_;
  if (events_ < settings_.roulette_depth) return true;
  return survives_roulette(max_component(way.throughput) / start_ * eta_scale_, u, way.throughput);
}

}  // namespace hyades::core
