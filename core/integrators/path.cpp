#include "core/integrators/path.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/integrators/light_parts.h"
#include "core/integrators/mis.h"
#include "core/integrators/path_in_words.h"
#include "core/integrators/random_walk.h"
#include "core/integrators/visibility.h"
#include "core/materials/shaded_surface.h"
#include "core/media/shares.h"
#include "core/scene/media_around.h"

namespace hyades::core {
namespace {

// Dimensions of one bounce: two groups of four of the sampler.
enum BounceDimension : uint32_t {
  kLight = 0,  // place on it (2), which light, which part of it
  kBsdf = 4,   // direction (2), lobe, roulette
  kPerBounce = 8,
};

/// One path on its way from the camera.
class Path final : public WalkWatcher {
 public:
  Path(const IntegratorDesc& settings, const Scene& scene, const Ray& ray, Sampler& sampler,
       Workspace& work)
      : settings_(settings),
        scene_(scene),
        sampler_(sampler),
        work_(work),
        walk_(settings, scene, sampler, work,
              {TransportMode::radiance, kCameraDimensions + kBsdf, kPerBounce,
               MediaNumbers::Purpose::flight, MediaNumbers::Purpose::passing},
              camera_segment(scene, ray), *this) {
    previous_.position = ray.origin;
  }

  PixelSample trace() {
    ScatteringPlace place;
    while (walk_.next(place)) {
      if (!(place.object != nullptr ? scatter_on_surface(place) : scatter_in_medium(place))) break;
    }
    return out_;
  }

 private:
  /// Scattering events so far.
  int depth() const { return walk_.events(); }
  const Ray& ray() const { return walk_.segment().ray; }

  static PathSegment camera_segment(const Scene& scene, const Ray& ray) {
    PathSegment segment;  // by assignment: an initializer list would clear what is not used, too
    segment.ray = ray;
    segment.specular = true;
    segment.around = bodies_around_lens(scene, ray);
    return segment;
  }

  /// The first of the sampler's dimensions for choosing a light before the next scattering event.
  uint32_t light_dimension() const {
    return kCameraDimensions + static_cast<uint32_t>(depth()) * kPerBounce + kLight;
  }

  // What the walk meets.

  void medium_emits(const PathSegment& segment, const Rgb& radiance) override {
    add(radiance, depth(), LightSource::of(*segment.around.medium()));
  }

  void flies(const MediumSegment& flight, const SurfacePoint* surface,
             MediaNumbers& numbers) override {
    if (is_first_told()) first_ = {};  // in the volume, until the path meets a surface
    add_light_from_near(flight, surface, numbers.next());
  }

  void meets(const PathSegment& /*segment*/, const SurfacePoint& point, const SceneObject& object,
             bool passed) override {
    if (!passed) {
      if (depth() == 0) note_first_surface(point);
      if (work_.log != nullptr) log_hit(point, object);
    }
    if (!lights_found_) add_emission(point, object);
  }

  void meets_holdout(const SceneObject& object) override {
    if (work_.log == nullptr) return;
    work_.log->lines.push_back(fmt::format("  meets the holdout '{}'", object.name));
  }

  void leaves(const PathSegment& /*segment*/) override {
    if (work_.log != nullptr) work_.log->lines.emplace_back("  leaves the scene");
    if (!lights_found_) add_sky();
  }

  void loses_roulette() override {
    if (work_.log != nullptr) work_.log->lines.emplace_back("  ended by roulette");
  }

  /// Adds `light` of `source` times the path's throughput; what came by more than one bounce may be
  /// clamped on request.
  void add(const Rgb& light, int events, const LightSource& source) {
    if (events < settings_.min_events || events > settings_.max_events) return;
    Rgb contribution = walk_.segment().throughput * light;
    if (settings_.clamp > 0.0F && events > 1)
      contribution = glm::min(contribution, Rgb(settings_.clamp));
    out_.radiance += contribution;
    if (work_.parts != nullptr) work_.parts->add(first_, events, source, contribution);
    if (work_.log != nullptr && !is_black(contribution)) {
      work_.log->lines.push_back("    light arrives: " + in_words(contribution));
    }
  }

  /// Weight of light that a sampled direction found, against choosing that light: from where the
  /// path scattered or, in a medium, from another place on the way there.
  float bsdf_weight(uint32_t index, float light_pdf) const {
    const PathSegment& segment = walk_.segment();
    if (segment.specular || !(light_pdf > 0.0F)) return 1.0F;
    const Previous& from = previous_;
    const float chosen =
        scene_.selector->probability(from.position, from.normal, index, from.lists) * light_pdf;
    const float near = near_density(from.flight, index, from.t, from.t_pdf, from.lists) * light_pdf;
    return power_heuristic(static_cast<float>(segment.pdf),
                           std::sqrt(chosen * chosen + near * near));
  }

  /// The density with which add_light_from_near chooses light `index` and the place at `t` of
  /// `flight`, over that of free flight there, `t_pdf`.
  float near_density(const MediumSegment& flight, uint32_t index, float t, float t_pdf,
                     ListBits lists) const {
    const float rival = flight.rival(*scene_.lights[index], t, t_pdf);
    if (!(rival > 0.0F)) return 0.0F;
    return rival * scene_.selector->probability_along(flight.ray, flight.t_max, index, lists);
  }

  /// Whether what the path meets of light `index` is light: from where it scattered last, by the
  /// kind of its ray.
  bool is_lit_by(uint32_t index) const {
    return depth() == 0 || (scene_.links(index, previous_.lists) &&
                            meet(scene_.light_links[index].seen_by, walk_.segment().kind));
  }

  /// Whether light `index` is looked for: one whose blockers are `list`, or any.
  bool is_looked_for(uint32_t index, std::optional<uint8_t> list) const {
    return is_lit_by(index) && (!list || scene_.light_links[index].blockers == *list);
  }

  /// Adds what infinite lights send, of which `share` comes through: all, or those of `list`.
  void add_sky(const Rgb& share = Rgb(1.0F), std::optional<uint8_t> list = {}) {
    if (depth() == 0 && !scene_.environment_visible) return;
    const PathSegment& segment = walk_.segment();
    const Vec3& direction = segment.ray.direction;
    const SurfacePoint nowhere;
    for (const uint32_t index : scene_.infinite_lights) {
      if (!is_looked_for(index, list)) continue;
      const Light& light = *scene_.lights[index];
      const Rgb radiance = light.radiance(nowhere, -direction);
      if (is_black(radiance)) continue;
      const float pdf =
          segment.specular ? 0.0F : light.pdf_direct(previous_.position, direction, nowhere);
      add(share * radiance * bsdf_weight(index, pdf), depth(), {index, true});
    }
  }

  void add_emission(const SurfacePoint& point, const SceneObject& object,
                    const Rgb& share = Rgb(1.0F), std::optional<uint8_t> list = {}) {
    if (object.light == SceneObject::kNoLight || !is_looked_for(object.light, list)) return;
    const Light& light = *scene_.lights[object.light];
    const PathSegment& segment = walk_.segment();
    const Vec3& direction = segment.ray.direction;
    const Rgb radiance = light.radiance(point, -direction);
    if (is_black(radiance)) return;
    const float pdf =
        segment.specular ? 0.0F : light.pdf_direct(previous_.position, direction, point);
    add(share * radiance * bsdf_weight(object.light, pdf), depth(), {object.light});
  }

  /// Where shadow rays see other things than those that go on: adds the lights that the way from
  /// the last scattering meets, of which as much comes here as does to who chooses them. Then what
  /// the walk meets is no light again. Delta lobes only see what they see.
  void find_lights() {
    lights_found_ = scene_.shadows_differ && !walk_.segment().specular;
    if (!lights_found_) return;
    if (work_.log != nullptr) work_.log->lines.emplace_back("  looks for lights as shadow rays do");
    MediaNumbers numbers(sampler_, depth(), MediaNumbers::Purpose::connection);
    for (ListBits left = scene_.blocker_lists; left != 0; left &= left - 1)
      find_lights_of(static_cast<uint8_t>(std::countr_zero(left)), numbers);
  }

  /// Those whose blockers are `list`.
  void find_lights_of(uint8_t list, MediaNumbers& numbers) {
    const PathSegment& segment = walk_.segment();
    MediumStack inside = segment.around;
    keep_seen(scene_, RayKind::shadow, inside);
    keep_blockers(scene_, list, inside);
    Ray way = segment.ray;
    Rgb share(1.0F);
    SurfacePoint point;
    for (int crossings = 0; crossings < kMaxNullCrossings; ++crossings) {
      ++work_.rays;
      point = {};
      const bool met = scene_.world->nearest(way, segment.kind | RayKind::shadow, point);
      if (const Medium* medium = inside.medium(); medium != nullptr) {
        share *= medium->transmittance(way, met ? point.t : kInfinity, numbers.next());
      }
      if (is_black(share)) return;
      if (!met) return add_sky(share, list);
      const SceneObject& object = scene_.objects[point.object];
      const RayKind seen_by = scene_.world->placement(point.object).seen_by;
      if (meet(seen_by, segment.kind)) add_emission(point, object, share, list);
      if (meet(seen_by, RayKind::shadow) && is_blocker(object, list)) {
        if (!goes_straight(object, point, inside, numbers)) return;
        cross(object, point, way.direction, inside);
      }
      way = spawn_ray(point, way.direction);
    }
  }

  void add_direct_light(const ShadedSurface& surface, const SceneObject& object, const Vec3& wo) {
    const SurfacePoint& point = surface.point();
    const auto chosen = choose_light(point.position, point.ng, object.in_lists);
    if (!chosen) return;
    const LightSample& sample = chosen->sample;
    Rgb f = surface.evaluate(wo, sample.direction, TransportMode::radiance);
    if (is_black(f)) return;
    if (is_first_told() || scene_.tells_rays_apart) {
      FirstEvent event = FirstEvent::at(surface, wo, sample.direction, false);
      if (scene_.tells_rays_apart) f *= event.keep(scene_.light_links[chosen->index].seen_by);
      if (is_first_told()) first_ = event;
      if (is_black(f)) return;
    }
    const Ray shadow = shadow_ray(point, sample);
    const float pdf = surface.pdf(wo, sample.direction, TransportMode::radiance);
    const float weight = sample.delta ? 1.0F : power_heuristic(chosen->pdf(), pdf);
    const MediumStack& around = walk_.segment().around;
    if (!passes_through(point, wo, sample.direction)) {
      return add_light(*chosen, f, weight, shadow, around, MediaNumbers::Purpose::shadow);
    }
    MediumStack beyond = around;
    cross(object, point, sample.direction, beyond);
    add_light(*chosen, f, weight, shadow, beyond, MediaNumbers::Purpose::shadow);
  }

  /// Adds light that is scattered at `place` in a medium, where free flight has ended. `pdf`: its
  /// density there; 0: unknown.
  void add_direct_light(const ScatteringPlace& place, float pdf) {
    const PathSegment& segment = walk_.segment();
    const ListBits lists = scene_.lists_within(segment.around);
    const auto chosen = choose_light(place.position, Vec3(0.0F), lists);
    if (!chosen || !is_lit_in_media(chosen->index)) return;
    const LightSample& sample = chosen->sample;
    const Phase& phase = place.flight.medium->phase();
    const float cosine = glm::dot(segment.ray.direction, sample.direction);
    const float scattered =
        sample.delta ? 0.0F : phase.pdf(cosine, channel_shares(segment.throughput));
    const float near = near_density(place.flight, chosen->index, place.t, pdf, lists) * sample.pdf;
    const float weight =
        power_heuristic(chosen->pdf(), std::sqrt(scattered * scattered + near * near));
    add_light(*chosen, phase.evaluate(cosine), weight,
              shadow_ray(place.position, sample, segment.ray.time), segment.around,
              MediaNumbers::Purpose::shadow);
  }

  /// Light scattered once more at a place near a light, besides the one where free flight ends:
  /// together, by the power heuristic over places and directions, they find lamps in fog at once.
  void add_light_from_near(const MediumSegment& flight, const SurfacePoint* surface,
                           const Vec4& u) {
    if (depth() >= std::min(settings_.max_depth, settings_.max_events)) return;
    if (scene_.selector->empty()) return;
    sampler_.set_dimension(light_dimension());
    const ListBits lists = scene_.lists_within(walk_.segment().around);
    const auto selected =
        scene_.selector->select_along(flight.ray, flight.t_max, sampler_.next_4d().z, lists);
    if (!selected || !scene_.links(selected->index, lists)) return;
    if (!is_lit_in_media(selected->index)) return;
    const Light& light = *scene_.lights[selected->index];
    const std::optional<Equiangular> places = flight.places_near(light);
    if (!places) return;
    const float t = places->sample(u.x);
    const Vec3 position = place_in_medium(flight.ray, t, surface);
    const auto sample = light.sample_direct(position, flight.ray.time, u.w, Vec2(u.y, u.z));
    if (!sample || is_black(sample->radiance)) return;
    const ChosenLight chosen{selected->index, selected->probability, *sample};
    const FlightDensity density = *flight.medium->flight_density(t, flight.shares);
    const PathSegment& segment = walk_.segment();
    const Phase& phase = flight.medium->phase();
    const float cosine = glm::dot(flight.ray.direction, sample->direction);
    // The shares after scattering there, which the direction would be chosen with.
    const Rgb shares = channel_shares(segment.throughput * density.scattered);
    const float scattered = sample->delta ? 0.0F : phase.pdf(cosine, shares) / chosen.pdf();
    const float there = scene_.selector->probability(position, Vec3(0.0F), selected->index, lists) /
                        selected->probability;
    const float pdf = places->pdf(t);
    const float other = density.pdf / pdf;
    const float weight = 1.0F / (1.0F + other * other * (there * there + scattered * scattered));
    add_light(chosen, phase.evaluate(cosine) * density.scattered / pdf, weight,
              shadow_ray(position, *sample, segment.ray.time), segment.around,
              MediaNumbers::Purpose::connection);
  }

  /// A place on a light that may be seen from where the path is.
  struct ChosenLight {
    uint32_t index = 0;
    float probability = 0.0F;
    LightSample sample;

    float pdf() const { return probability * sample.pdf; }
  };

  /// Whether media are lit by light `index` at all.
  bool is_lit_in_media(uint32_t index) const {
    return meet(scene_.light_links[index].seen_by, RayKind::volume);
  }

  /// For the place `from` with normal `normal` (zero: none, in a medium), which is in `lists`.
  std::optional<ChosenLight> choose_light(const Vec3& from, const Vec3& normal, ListBits lists) {
    if (scene_.selector->empty()) return std::nullopt;
    sampler_.set_dimension(light_dimension());
    const Vec4 u = sampler_.next_4d();
    const auto selected = scene_.selector->select(from, normal, u.z, lists);
    if (!selected || !scene_.links(selected->index, lists)) return std::nullopt;
    const auto sample =
        scene_.lights[selected->index]->sample_direct(from, ray().time, u.w, Vec2(u));
    if (!sample || is_black(sample->radiance)) return std::nullopt;
    return ChosenLight{selected->index, selected->probability, *sample};
  }

  /// Adds what `chosen` sends along `shadow`, scattered by `f`, with `weight`.
  void add_light(const ChosenLight& chosen, const Rgb& f, float weight, const Ray& shadow,
                 const MediumStack& around, MediaNumbers::Purpose purpose) {
    const Rgb share =
        visible_share(scene_, shadow, around, MediaNumbers(sampler_, depth(), purpose), work_,
                      scene_.light_links[chosen.index].blockers);
    if (is_black(share)) return;
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("    chooses light '{}', weight {:.4g}",
                                             scene_.light_names[chosen.index], weight));
    }
    add(f * chosen.sample.radiance * share * (weight / chosen.pdf()), depth() + 1, {chosen.index});
  }

  static bool passes_through(const SurfacePoint& point, const Vec3& wo, const Vec3& wi) {
    return glm::dot(wo, point.ng) * glm::dot(wi, point.ng) < 0.0F;
  }

  /// Adds the light that is scattered at `place` in a medium, and goes on from there; false where
  /// the path ends.
  bool scatter_in_medium(const ScatteringPlace& place) {
    if (depth() == 0) out_.alpha = 1.0F;
    if (!albedo_noted_) {
      out_.albedo = walk_.segment().throughput;
      albedo_noted_ = true;
    }
    if (work_.log != nullptr)
      work_.log->lines.push_back("  scatters in the medium at " + in_words(place.position));
    if (depth() >= std::min(settings_.max_depth, settings_.max_events)) return false;
    const Medium& medium = *place.flight.medium;
    const auto density = medium.flight_density(place.t, place.flight.shares);
    const float t_pdf = density ? density->pdf : 0.0F;
    add_direct_light(place, t_pdf);
    if (!walk_.scatter(medium, place.position)) return false;
    previous_ = {place.position, Vec3(0.0F), scene_.lists_within(walk_.segment().around),
                 place.flight,   place.t,    t_pdf};
    find_lights();
    return true;
  }

  /// Adds the light that is scattered at `place` on a surface, and goes on along its BSDF; false
  /// where the path ends.
  bool scatter_on_surface(const ScatteringPlace& place) {
    const bool last = depth() >= settings_.max_depth;
    const bool all_lit = depth() >= settings_.max_events;
    if ((last || all_lit) && albedo_noted_) return false;

    work_.arena.reset();
    const SceneObject& object = *place.object;
    const ShadedSurface surface(place.point, *object.material, work_.arena);
    if (surface.bsdf() == nullptr) return false;
    const Vec3 wo = -ray().direction;
    if (!albedo_noted_) note_albedo(surface, wo);
    if (last || (all_lit && albedo_noted_)) return false;
    if (surface.has_smooth()) add_direct_light(surface, object, wo);
    const bool first_told = is_first_told();
    const auto sample = walk_.scatter(surface, object, wo);
    if (!sample) return false;
    if (first_told) {
      first_ = FirstEvent::at(surface, wo, sample->wi, sample->delta);
      if (scene_.tells_rays_apart) (void)first_.keep(walk_.segment().kind);
    }
    previous_ = {place.position, place.point.ng, object.in_lists, {}};
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("  {} {} along {}, weight {}",
                                             sample->delta ? "specular" : "scattered",
                                             sample->transmitted ? "transmission" : "reflection",
                                             in_words(sample->wi), in_words(sample->weight)));
    }
    find_lights();
    return true;
  }

  /// Whether light is told apart by the event at hand.
  bool is_first_told() const { return work_.parts != nullptr && depth() == 0; }

  void note_first_surface(const SurfacePoint& point) {
    out_.alpha = 1.0F;
    out_.depth = scene_.camera->depth_of(point.position, point.time);
    out_.normal = point.ns;
    out_.object = point.object;
    out_.primitive = point.primitive;
    out_.position = point.position;
  }

  void note_albedo(const ShadedSurface& surface, const Vec3& wo) {
    if (!surface.has_smooth()) return;
    out_.albedo = walk_.segment().throughput * surface.albedo(wo);
    albedo_noted_ = true;
  }

  void log_hit(const SurfacePoint& point, const SceneObject& object) {
    const bool mesh = scene_.world->placement(point.object).shape.kind == Shape::Kind::mesh;
    work_.log->lines.push_back(
        fmt::format("  meets '{}'{} at {} after {:.6g} m, normal {}", object.name,
                    mesh ? fmt::format(" (triangle {})", point.primitive) : std::string(),
                    in_words(point.position), point.t, in_words(point.ns)));
  }

  /// Where the path scattered last: what light selection and MIS refer to.
  struct Previous {
    Vec3 position{0.0F};
    Vec3 normal{0.0F};
    ListBits lists = kAllLists;  ///< that what is there is in
    MediumSegment flight;        ///< in a medium: on which the path came there
    float t = 0.0F;              ///< how far along it
    float t_pdf = 0.0F;          ///< density with which free flight ended there; 0: unknown
  };

  const IntegratorDesc& settings_;
  const Scene& scene_;
  Sampler& sampler_;
  Workspace& work_;
  RandomWalk walk_;
  PixelSample out_;
  Previous previous_;
  bool lights_found_ = false;  ///< those on the way that the walk is on (find_lights)
  FirstEvent first_;           ///< of the path's events, where light is told apart
  bool albedo_noted_ = false;
};

class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorDesc& settings) : settings_(settings) {}

  PixelSample sample(const Scene& scene, const Ray& ray, Sampler& sampler,
                     Workspace& work) const override {
    return Path(settings_, scene, ray, sampler, work).trace();
  }

 private:
  IntegratorDesc settings_;
};

}  // namespace

std::unique_ptr<Integrator> make_path_integrator(const IntegratorDesc& desc) {
  return std::make_unique<PathIntegrator>(desc);
}

}  // namespace hyades::core
