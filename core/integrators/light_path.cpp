#include "core/integrators/light_path.h"

#include <cmath>

#include "core/base/frame.h"
#include "core/base/warp.h"
#include "core/scene/media_around.h"

namespace hyades::core {
namespace {

/// A ball around the world; empty worlds have none.
struct Ball {
  Vec3 center{0.0F};
  float radius = 0.0F;
};

Ball ball_around(const Bounds& bounds) {
  if (bounds.empty()) return {};
  const Vec3 size = bounds.size();
  return {bounds.center(), 0.5F * std::sqrt(glm::dot(size, size)) * 1.001F};
}

/// Density per area of rays through the disc that covers the world.
double pdf_across(const Scene& scene) {
  const double radius = static_cast<double>(ball_around(scene.world->bounds()).radius);
  return radius > 0.0 ? 1.0 / (static_cast<double>(kPi) * radius * radius) : 0.0;
}

std::optional<PathSegment> begin_far_away(const Scene& scene, const Light& light, float probability,
                                          float time, float pick, const Vec2& place,
                                          const Vec2& direction, PathVertex& first) {
  const Ball ball = ball_around(scene.world->bounds());
  if (!(ball.radius > 0.0F)) return std::nullopt;
  const auto sample = light.sample_direct(ball.center, time, pick, direction);
  if (!sample || is_black(sample->radiance)) return std::nullopt;
  const Frame frame = Frame::around(sample->direction);
  const Vec2 disc = square_to_disk(place);
  first.infinitely_far = true;
  first.density = static_cast<double>(probability) * static_cast<double>(sample->pdf_place);
  PathSegment segment;
  segment.ray.origin = ball.center + ball.radius * (frame.n + disc.x * frame.s + disc.y * frame.t);
  segment.ray.direction = -sample->direction;
  segment.ray.time = time;
  segment.pdf_across = pdf_across(scene);
  segment.throughput =
      sample->radiance *
      static_cast<float>(1.0 / (static_cast<double>(probability) *
                                static_cast<double>(sample->pdf) * segment.pdf_across));
  if (const Medium* air = scene.atmosphere.get(); air != nullptr) {
    // All the way from there: nothing, but in channels that it does not touch.
    const Ray all_the_way{segment.ray.origin, sample->direction, kInfinity, time};
    segment.throughput *= air->transmittance(all_the_way, kInfinity, Vec4(0.5F));
    if (is_black(segment.throughput)) return std::nullopt;
  }
  segment.kind = RayKind::diffuse;
  segment.around = MediumStack(scene.atmosphere.get());
  return segment;
}

std::optional<PathSegment> begin_at_place(const Scene& scene, const Light& light, float probability,
                                          float time, float pick, const Vec2& place,
                                          const Vec2& direction, PathVertex& first) {
  const auto sample = light.sample_emission(time, pick, place, direction);
  if (!sample || is_black(sample->weight)) return std::nullopt;
  first.point = sample->on;
  first.position = sample->on.position;
  first.density = static_cast<double>(probability) * static_cast<double>(sample->pdf_place);
  PathSegment segment;
  segment.ray = spawn_ray(sample->on, sample->direction);
  segment.throughput = sample->weight / probability;
  segment.pdf = static_cast<double>(sample->pdf_direction);
  segment.kind = RayKind::diffuse;
  segment.around = media_around(scene, segment.ray.origin, time);
  return segment;
}

}  // namespace

LightPathStart begin_light_path(const Scene& scene, float time, Sampler& sampler, Subpath& path) {
  path.clear();
  sampler.set_dimension(kLightPathDimensions);
  const Vec4 a = sampler.next_4d();
  const Vec4 b = sampler.next_4d();
  LightPathStart start;
  start.lens = {b.z, b.w};
  if (scene.selector->empty()) return start;
  const auto selected = scene.selector->select_emitter(a.z);
  if (!selected) return start;
  const Light& light = *scene.lights[selected->index];
  PathVertex& first = path.add(PathVertex::Kind::light);
  first.light = selected->index;
  const auto begin = light.is_infinite() ? begin_far_away : begin_at_place;
  start.segment = begin(scene, light, selected->probability, time, a.w, Vec2(a), Vec2(b), first);
  if (!start.segment) {
    path.clear();
    return start;
  }
  first.chain = light.is_delta() ? 0.0 : 1.0;  // whether camera paths can meet it
  return start;
}

double emission_density(const Scene& scene, const Light& light, const PathVertex& on,
                        const PathVertex& v, const Vec3& direction) {
  if (on.infinitely_far) return pdf_across(scene) * v.across(direction);
  return static_cast<double>(light.pdf_outward(on.point.ng, -direction)) *
         v.per_direction(on.position, -direction);
}

LightDensities light_densities(const Scene& scene, const PathVertex& on, const PathVertex& before,
                               const Vec3& direction) {
  const Light& light = *scene.lights[on.light];
  const LightSelector& selector = *scene.selector;
  LightDensities densities;
  const double selected = static_cast<double>(selector.probability(
      before.position, before.selection_normal(), on.light, before.lists(scene)));
  densities.chosen =
      light.is_delta()
          ? selected
          : selected * static_cast<double>(light.pdf_direct(before.position, direction, on.point)) *
                on.per_direction(before.position, direction);
  densities.emitted = static_cast<double>(selector.emitter_probability(on.light)) *
                      static_cast<double>(light.pdf_place(on.point, direction));
  densities.towards = emission_density(scene, light, on, before, direction);
  return densities;
}

bool FirstLightVertex::arrives(const PathVertex& vertex) {
  if (path_.size() != 2) return true;
  if (!scene_.links(path_[0].light, vertex.lists(scene_))) return false;
  const double chosen = light_densities(scene_, path_[0], vertex, vertex.wo).chosen;
  const double share = chosen / path_[0].density;
  path_[1].edge = share * share;
  return true;
}

}  // namespace hyades::core
