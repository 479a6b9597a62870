#include "core/integrators/path.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/integrators/light_parts.h"
#include "core/integrators/medium_way.h"
#include "core/integrators/mis.h"
#include "core/integrators/path_in_words.h"
#include "core/integrators/roulette.h"
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

/// The state of one path on its way from the camera.
class Path {
 public:
  Path(const IntegratorDesc& settings, const Scene& scene, const Ray& ray, Sampler& sampler,
       Workspace& work)
      : settings_(settings),
        scene_(scene),
        ray_(ray),
        sampler_(sampler),
        work_(work),
        around_(bodies_around_lens(scene, ray)),
        numbers_(sampler, 0, MediaNumbers::Purpose::flight),
        passing_(sampler, 0, MediaNumbers::Purpose::passing) {}

  PixelSample trace() {
    previous_.position = ray_.origin;
    int null_crossings = 0;
    while (true) {
      ++work_.rays;
      SurfacePoint point;
      const RayKind kind = depth_ == 0 ? RayKind::camera : RayKind::other;
      const bool met = scene_.world->nearest(ray_, kind, point);
      if (const Medium* medium = around_.medium(); medium != nullptr) {
        const Flight flight = fly(*medium, met ? &point : nullptr);
        if (flight == Flight::ended) break;
        if (flight == Flight::scattered) continue;
      }
      if (!met) {
        add_sky();
        break;
      }
      const SceneObject& object = scene_.objects[point.object];
      const bool unseen = is_unseen(object, point, ray_.direction, kind);
      if (unseen || goes_straight(object, point, around_, passing_)) {
        if (!unseen) add_emission(point, object);
        if (++null_crossings > kMaxNullCrossings) break;
        cross(object, point, ray_.direction, around_);
        ray_ = spawn_ray(point, ray_.direction);
        ray_.time = point.time;
        continue;
      }
      if (depth_ == 0) note_first_surface(point);
      if (work_.log != nullptr) log_hit(point, object);
      add_emission(point, object);
      const bool last = depth_ >= settings_.max_depth;
      const bool all_lit = depth_ >= settings_.max_events;
      if ((last || all_lit) && albedo_noted_) break;

      work_.arena.reset();
      point.outside_index = around_.index_outside(object.body);
      const ShadedSurface surface(point, *object.material, work_.arena);
      if (surface.bsdf() == nullptr) break;
      const Vec3 wo = -ray_.direction;
      if (!albedo_noted_) note_albedo(surface, wo);
      if (last || (all_lit && albedo_noted_)) break;
      const uint32_t dimension = event_dimension();
      if (surface.has_smooth()) add_direct_light(surface, object, wo, dimension);
      if (!scatter(surface, object, wo, dimension)) break;
    }
    return out_;
  }

 private:
  /// The first of the sampler's dimensions of the next scattering event.
  uint32_t event_dimension() const {
    return kCameraDimensions + static_cast<uint32_t>(depth_) * kPerBounce;
  }

  /// Adds `light` of `source` times the path's throughput; what came by more than one bounce may be
  /// clamped on request.
  void add(const Rgb& light, int events, const LightSource& source) {
    if (events < settings_.min_events || events > settings_.max_events) return;
    Rgb contribution = throughput_ * light;
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
    if (previous_.specular) return 1.0F;
    const float chosen =
        scene_.selector->probability(previous_.position, previous_.normal, index) * light_pdf;
    const float near = near_density(previous_.way, index, previous_.t, previous_.t_pdf) * light_pdf;
    return power_heuristic(previous_.pdf, std::sqrt(chosen * chosen + near * near));
  }

  /// The density with which add_light_from_near chooses light `index` and the place at `t` of
  /// `way`, over that of free flight there, `t_pdf`.
  float near_density(const MediumWay& way, uint32_t index, float t, float t_pdf) const {
    const float rival = way.rival(*scene_.lights[index], t, t_pdf);
    if (!(rival > 0.0F)) return 0.0F;
    return rival * scene_.selector->probability_along(way.ray, way.t_max, index);
  }

  void add_sky() {
    if (work_.log != nullptr) work_.log->lines.emplace_back("  leaves the scene");
    if (depth_ == 0 && !scene_.environment_visible) return;
    const SurfacePoint nowhere;
    for (const uint32_t index : scene_.infinite_lights) {
      const Light& light = *scene_.lights[index];
      const Rgb radiance = light.radiance(nowhere, -ray_.direction);
      if (is_black(radiance)) continue;
      const float pdf =
          previous_.specular ? 0.0F : light.pdf_direct(previous_.position, ray_.direction, nowhere);
      add(radiance * bsdf_weight(index, pdf), depth_, {index, true});
    }
  }

  void add_emission(const SurfacePoint& point, const SceneObject& object) {
    if (object.light == SceneObject::kNoLight) return;
    const Light& light = *scene_.lights[object.light];
    const Rgb radiance = light.radiance(point, -ray_.direction);
    if (is_black(radiance)) return;
    const float pdf =
        previous_.specular ? 0.0F : light.pdf_direct(previous_.position, ray_.direction, point);
    add(radiance * bsdf_weight(object.light, pdf), depth_, {object.light});
  }

  void add_direct_light(const ShadedSurface& surface, const SceneObject& object, const Vec3& wo,
                        uint32_t dimension) {
    const SurfacePoint& point = surface.point();
    const auto chosen = choose_light(point.position, point.ng, dimension);
    if (!chosen) return;
    const LightSample& sample = chosen->sample;
    const Rgb f = surface.evaluate(wo, sample.direction, TransportMode::radiance);
    if (is_black(f)) return;
    const Ray shadow = shadow_ray(point, sample);
    const float pdf = surface.pdf(wo, sample.direction, TransportMode::radiance);
    const float weight = sample.delta ? 1.0F : power_heuristic(chosen->pdf(), pdf);
    if (is_first_told()) first_ = FirstEvent::at(surface, wo, sample.direction, false);
    if (!passes_through(point, wo, sample.direction)) {
      return add_light(*chosen, f, weight, shadow, around_, MediaNumbers::Purpose::shadow);
    }
    MediumStack beyond = around_;
    cross(object, point, sample.direction, beyond);
    add_light(*chosen, f, weight, shadow, beyond, MediaNumbers::Purpose::shadow);
  }

  /// The same for the place at `t` of a way through a medium, where free flight has ended. `pdf`:
  /// its density there; 0: unknown.
  void add_direct_light(const MediumWay& way, float t, float pdf, const Vec3& position,
                        uint32_t dimension) {
    const auto chosen = choose_light(position, Vec3(0.0F), dimension);
    if (!chosen) return;
    const LightSample& sample = chosen->sample;
    const Phase& phase = way.medium->phase();
    const float cosine = glm::dot(ray_.direction, sample.direction);
    const float scattered = sample.delta ? 0.0F : phase.pdf(cosine, channel_shares(throughput_));
    const float near = near_density(way, chosen->index, t, pdf) * sample.pdf;
    const float weight =
        power_heuristic(chosen->pdf(), std::sqrt(scattered * scattered + near * near));
    add_light(*chosen, phase.evaluate(cosine), weight, shadow_ray(position, sample, ray_.time),
              around_, MediaNumbers::Purpose::shadow);
  }

  /// Light scattered once more at a place near a light, besides the one where free flight ends:
  /// together, by the power heuristic over places and directions, they find lamps in fog at once.
  void add_light_from_near(const MediumWay& way, const SurfacePoint* surface, const Vec4& u) {
    if (depth_ >= std::min(settings_.max_depth, settings_.max_events)) return;
    if (scene_.lights.empty()) return;
    sampler_.set_dimension(event_dimension() + kLight);
    const auto selected = scene_.selector->select_along(way.ray, way.t_max, sampler_.next_4d().z);
    if (!selected) return;
    const Light& light = *scene_.lights[selected->index];
    const std::optional<Equiangular> places = way.places_near(light);
    if (!places) return;
    const float t = places->sample(u.x);
    const Vec3 position = place_in_medium(ray_, t, surface);
    const auto sample = light.sample_direct(position, way.ray.time, u.w, Vec2(u.y, u.z));
    if (!sample || is_black(sample->radiance)) return;
    const ChosenLight chosen{selected->index, selected->probability, *sample};
    const FlightDensity flight = *way.medium->flight_density(t, way.shares);
    const Phase& phase = way.medium->phase();
    const float cosine = glm::dot(way.ray.direction, sample->direction);
    // The shares after scattering there, which the direction would be chosen with.
    const Rgb shares = channel_shares(throughput_ * flight.scattered);
    const float scattered = sample->delta ? 0.0F : phase.pdf(cosine, shares) / chosen.pdf();
    const float there =
        scene_.selector->probability(position, Vec3(0.0F), selected->index) / selected->probability;
    const float pdf = places->pdf(t);
    const float other = flight.pdf / pdf;
    const float weight = 1.0F / (1.0F + other * other * (there * there + scattered * scattered));
    add_light(chosen, phase.evaluate(cosine) * flight.scattered / pdf, weight,
              shadow_ray(position, *sample, ray_.time), around_, MediaNumbers::Purpose::connection);
  }

  /// A place on a light that may be seen from where the path is.
  struct ChosenLight {
    uint32_t index = 0;
    float probability = 0.0F;
    LightSample sample;

    float pdf() const { return probability * sample.pdf; }
  };

  /// For the place `from` with normal `normal` (zero: none, in a medium).
  std::optional<ChosenLight> choose_light(const Vec3& from, const Vec3& normal,
                                          uint32_t dimension) {
    if (scene_.lights.empty()) return std::nullopt;
    sampler_.set_dimension(dimension + kLight);
    const Vec4 u = sampler_.next_4d();
    const auto selected = scene_.selector->select(from, normal, u.z);
    if (!selected) return std::nullopt;
    const auto sample =
        scene_.lights[selected->index]->sample_direct(from, ray_.time, u.w, Vec2(u));
    if (!sample || is_black(sample->radiance)) return std::nullopt;
    return ChosenLight{selected->index, selected->probability, *sample};
  }

  /// Adds what `chosen` sends along `shadow`, scattered by `f`, with `weight`.
  void add_light(const ChosenLight& chosen, const Rgb& f, float weight, const Ray& shadow,
                 const MediumStack& around, MediaNumbers::Purpose purpose) {
    const Rgb share =
        visible_share(scene_, shadow, around, MediaNumbers(sampler_, depth_, purpose), work_);
    if (is_black(share)) return;
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("    chooses light '{}', weight {:.4g}",
                                             scene_.light_names[chosen.index], weight));
    }
    add(f * chosen.sample.radiance * share * (weight / chosen.pdf()), depth_ + 1, {chosen.index});
  }

  static bool passes_through(const SurfacePoint& point, const Vec3& wo, const Vec3& wi) {
    return glm::dot(wo, point.ng) * glm::dot(wi, point.ng) < 0.0F;
  }

  enum class Flight { passed, scattered, ended };

  /// Goes through `medium` to the surface that the ray meets (null: to infinity), or to where it
  /// scatters: there light is added and a new direction taken.
  Flight fly(const Medium& medium, const SurfacePoint* surface) {
    const float t_max = surface != nullptr ? surface->t : kInfinity;
    const Vec4 u = numbers_.next();
    if (const Rgb emitted = medium.emitted(ray_, t_max, u); !is_black(emitted))
      add(emitted, depth_, LightSource::of(medium));
    const MediumWay way{ray_, t_max, &medium, channel_shares(throughput_), around_.open()};
    if (is_first_told()) first_ = {};  // in the volume, until the path meets a surface
    add_light_from_near(way, surface, numbers_.next());
    const MediumSample sample = medium.sample(ray_, t_max, way.shares, u);
    throughput_ *= sample.weight;
    if (is_black(throughput_)) return Flight::ended;
    if (!sample.scattered) return Flight::passed;
    return scatter(way, sample.t, place_in_medium(ray_, sample.t, surface)) ? Flight::scattered
                                                                            : Flight::ended;
  }

  bool scatter(const MediumWay& way, float t, const Vec3& position) {
    if (depth_ == 0) out_.alpha = 1.0F;
    if (!albedo_noted_) {
      out_.albedo = throughput_;
      albedo_noted_ = true;
    }
    if (work_.log != nullptr)
      work_.log->lines.push_back("  scatters in the medium at " + in_words(position));
    if (depth_ >= std::min(settings_.max_depth, settings_.max_events)) return false;
    const Phase& phase = way.medium->phase();
    const Rgb shares = channel_shares(throughput_);
    const auto flight = way.medium->flight_density(t, way.shares);
    const float t_pdf = flight ? flight->pdf : 0.0F;
    add_direct_light(way, t, t_pdf, position, event_dimension());

    sampler_.set_dimension(event_dimension() + kBsdf);
    const Vec4 u = sampler_.next_4d();
    const Vec3 direction = phase.sample(ray_.direction, shares, u.z, Vec2(u));
    const float cosine = glm::dot(ray_.direction, direction);
    const float pdf = phase.pdf(cosine, shares);
    if (!(pdf > 0.0F)) return false;
    throughput_ *= phase.evaluate(cosine) / pdf;
    if (!count_event(u.w)) return false;
    previous_ = {position, Vec3(0.0F), pdf, false, way, t, t_pdf};
    ray_ = {position, direction, kInfinity, ray_.time};
    return true;
  }

  /// Goes on along the BSDF; false where the path ends.
  bool scatter(const ShadedSurface& surface, const SceneObject& object, const Vec3& wo,
               uint32_t dimension) {
    sampler_.set_dimension(dimension + kBsdf);
    const Vec4 u = sampler_.next_4d();
    const auto sample = surface.sample(wo, u.z, Vec2(u), TransportMode::radiance);
    if (!sample || is_black(sample->weight)) return false;
    throughput_ *= sample->weight;
    if (is_first_told()) first_ = FirstEvent::at(surface, wo, sample->wi, sample->delta);
    eta_scale_ *= sample->eta * sample->eta;
    if (!count_event(u.w)) return false;
    const SurfacePoint& point = surface.point();
    previous_ = {point.position, point.ng, sample->pdf, sample->delta, {}};
    if (passes_through(point, wo, sample->wi)) cross(object, point, sample->wi, around_);
    ray_ = spawn_ray(point, sample->wi);
    ray_.time = point.time;
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("  {} {} along {}, weight {}",
                                             sample->delta ? "specular" : "scattered",
                                             sample->transmitted ? "transmission" : "reflection",
                                             in_words(sample->wi), in_words(sample->weight)));
    }
    return true;
  }

  /// Whether light is told apart by the event at hand.
  bool is_first_told() const { return work_.parts != nullptr && depth_ == 0; }

  /// One more scattering event; false where roulette, decided by `u`, ends the path.
  bool count_event(float u) {
    ++work_.bounces;
    ++depth_;
    numbers_ = MediaNumbers(sampler_, depth_, MediaNumbers::Purpose::flight);
    passing_ = MediaNumbers(sampler_, depth_, MediaNumbers::Purpose::passing);
    if (depth_ < settings_.roulette_depth) return true;
    if (survives_roulette(max_component(throughput_) * eta_scale_, u, throughput_)) return true;
    if (work_.log != nullptr) work_.log->lines.emplace_back("  ended by roulette");
    return false;
  }

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
    out_.albedo = throughput_ * surface.albedo(wo);
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
    float pdf = 0.0F;
    bool specular = true;  ///< a delta lobe, or the camera: lights could not have been chosen
    MediumWay way;         ///< in a medium: on which the path came there
    float t = 0.0F;        ///< how far along it
    float t_pdf = 0.0F;    ///< density with which free flight ended there; 0: unknown
  };

  const IntegratorDesc& settings_;
  const Scene& scene_;
  Ray ray_;
  Sampler& sampler_;
  Workspace& work_;
  PixelSample out_;
  Rgb throughput_{1.0F};
  Previous previous_;
  MediumStack around_;    ///< what the ray begins in
  MediaNumbers numbers_;  ///< for the way from the last event on
  MediaNumbers passing_;  ///< through surfaces on it
  float eta_scale_ = 1.0F;
  int depth_ = 0;     ///< scattering events so far
  FirstEvent first_;  ///< of them, where light is told apart
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
