#include "core/integrators/bdpt.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "core/integrators/chosen_joins.h"
#include "core/integrators/found_path.h"
#include "core/integrators/light_parts.h"
#include "core/integrators/light_path.h"
#include "core/integrators/path_in_words.h"
#include "core/integrators/subpath_walk.h"
#include "core/integrators/visibility.h"
#include "core/scene/media_around.h"

namespace hyades::core {
namespace {

// Dimensions of one event of the camera path, those of path tracing: two groups of four.
constexpr uint32_t kLightChoice = 0;  // place on it (2), which light, which part of it
constexpr uint32_t kScattering = 4;   // direction (2), lobe, roulette
constexpr uint32_t kPerEvent = 8;

struct BdptScratch : IntegratorScratch {
  Subpath camera;
  Subpath light;
  std::vector<Vec2> places;
};

double square(double x) { return x * x; }

/// Of densities; 0 where `a` is, also of a light that is seen edge-on, where `b` is 0 as well.
double ratio(double a, double b) { return a > 0.0 ? a / b : 0.0; }

/// One sample: a camera path, a light path, and all that joins them.
class BidirectionalSample final : public SubpathWatcher {
 public:
  BidirectionalSample(const IntegratorDesc& settings, const Scene& scene, const Ray& ray,
                      Sampler& sampler, Workspace& work, BdptScratch& scratch)
      : settings_(settings),
        scene_(scene),
        ray_(ray),
        sampler_(sampler),
        work_(work),
        camera_(scratch.camera),
        light_(scratch.light),
        places_(scratch.places),
        film_pixels_(static_cast<double>(scene.window.area())) {}

  PixelSample trace() {
    const LightPathStart start = begin_light_path(scene_, ray_.time, sampler_, light_);
    if (start.segment) walk_from_light(*start.segment);
    if (work_.log != nullptr) tell_subpath(scene_, light_, "light path", *work_.log);
    walk_from_camera();
    if (work_.log != nullptr) tell_subpath(scene_, camera_, "camera path", *work_.log);
    if (wanted(1)) {
      for (int t = 2; t <= camera_.size(); ++t) choose_light(t);
    }
    join_subpaths();
    for (int s = 2; s <= light_.size() && s - 1 <= settings_.max_depth; ++s) {
      join_lens(s, start.lens);
    }
    return out_;
  }

 private:
  bool wanted(int s) const { return settings_.light_vertices < 0 || settings_.light_vertices == s; }

  bool wanted(int s, int t) const {
    return s + t - 2 >= settings_.min_events && wanted(s) &&
           (settings_.camera_vertices < 0 || settings_.camera_vertices == t);
  }

  /// The weight of a strategy from the sums on either side.
  float weight(FoundPath path, double light_side, double camera_side) const {
    const double weight = 1.0 / (1.0 + light_side + camera_side);
    if (work_.watcher != nullptr) {
      path.weight = weight;
      work_.watcher->found(path);
    }
    return settings_.mis ? static_cast<float>(weight) : 1.0F;
  }

  /// Adds what the strategy with s vertices from the light and t from the camera brings; `first`:
  /// where the light is scattered towards the camera.
  void add(int s, int t, const LightSource& source, const FirstEvent& first, const Rgb& light) {
    out_.radiance += light;
    if (work_.parts != nullptr) work_.parts->add(first, s + t - 2, source, light);
    tell(s, t, light);
  }

  void tell(int s, int t, const Rgb& light) const {
    if (work_.log == nullptr || is_black(light)) return;
    work_.log->lines.push_back(fmt::format("strategy ({}, {}) brings {}", s, t, in_words(light)));
  }

  /// The event at `v` between the way to the camera and the way to the light.
  static FirstEvent event_at(const PathVertex& v, const Vec3& to_camera, const Vec3& to_light,
                             bool specular) {
    return v.kind == PathVertex::Kind::surface
               ? FirstEvent::at(*v.surface, to_camera, to_light, specular)
               : FirstEvent{};
  }

  /// The first event of a path whose camera vertex t - 1 is seen from the light along -`to_light`.
  FirstEvent first_event(int t, const Vec3& to_light) const {
    if (work_.parts == nullptr || t > 2) return first_;
    return event_at(camera_[1], camera_[1].wo, to_light, false);
  }

  FoundPath path_of(int s, int t, uint32_t light) const { return {light_, camera_, s, t, light}; }

  void walk_from_camera() {
    camera_.clear();
    PathVertex& lens = camera_.add(PathVertex::Kind::lens);
    lens.position = ray_.origin;
    PathSegment segment{.ray = ray_, .around = bodies_around_lens(scene_, ray_)};
    const double density =
        static_cast<double>(scene_.camera->film_density(ray_.direction, ray_.time)) / film_pixels_;
    (scene_.camera->rays_are_parallel() ? segment.pdf_across : segment.pdf) = density;
    const WalkKind kind{TransportMode::radiance, kCameraDimensions + kScattering, kPerEvent,
                        MediaNumbers::Purpose::flight, MediaNumbers::Purpose::passing};
    RandomWalk walk(settings_, scene_, sampler_, work_, kind, segment, *this);
    lengthen(camera_, walk, settings_.max_depth + 2, *this);
  }

  void walk_from_light(const PathSegment& start) {
    FirstLightVertex watcher(scene_, light_);
    const WalkKind kind{TransportMode::importance, kLightPathDimensions + kLightPathStart, 4,
                        MediaNumbers::Purpose::light_flight, MediaNumbers::Purpose::light_passing};
    RandomWalk walk(settings_, scene_, sampler_, work_, kind, start, watcher);
    lengthen(light_, walk, settings_.max_depth + 1, watcher);
  }

  // What the camera path meets.

  void medium_emits(const PathSegment& segment, const Rgb& radiance) override {
    if (wanted(0, camera_.size() + 1))
      add(0, camera_.size() + 1, LightSource::of(*segment.around.medium()), first_,
          segment.throughput * radiance);
  }

  bool arrives(const PathVertex& v) override {
    if (camera_.size() == 2) {
      out_.alpha = 1.0F;
      if (v.kind == PathVertex::Kind::surface) {
        out_.object = v.point.object;
        out_.primitive = v.point.primitive;
        out_.position = v.position;
        out_.depth = scene_.camera->depth_of(v.position, ray_.time);
        out_.normal = v.point.ns;
      }
    }
    if (albedo_noted_ || !v.joins()) return true;
    out_.albedo = v.throughput;
    if (v.kind == PathVertex::Kind::surface) out_.albedo *= v.surface->albedo(v.wo);
    albedo_noted_ = true;
    return true;
  }

  void goes_on(const PathVertex& from, const PathSegment& segment) override {
    if (work_.parts != nullptr && camera_.size() == 2)
      first_ = event_at(from, from.wo, segment.ray.direction, segment.specular);
  }

  void meets(const PathSegment& segment, const SurfacePoint& point, const SceneObject& object,
             bool /*passed*/) override {
    if (object.light == SceneObject::kNoLight || !wanted(0, camera_.size() + 1)) return;
    const Light& light = *scene_.lights[object.light];
    const Rgb radiance = light.radiance(point, -segment.ray.direction);
    if (is_black(radiance)) return;
    PathVertex& on = met_light_;
    on.kind = PathVertex::Kind::light;
    on.position = point.position;
    on.point = point;
    on.light = object.light;
    on.infinitely_far = false;
    add_met_light(segment, on, radiance);
  }

  void leaves(const PathSegment& segment) override {
    if (!wanted(0, camera_.size() + 1)) return;
    if (camera_.size() == 1 && !scene_.environment_visible) return;
    for (const uint32_t index : scene_.infinite_lights) {
      const Light& light = *scene_.lights[index];
      const Rgb radiance = light.radiance(SurfacePoint(), -segment.ray.direction);
      if (is_black(radiance)) continue;
      PathVertex& sky = met_light_;
      sky.kind = PathVertex::Kind::light;
      sky.light = index;
      sky.infinitely_far = true;
      add_met_light(segment, sky, radiance);
    }
  }

  /// s = 0: `segment` from the last vertex of the camera path has come to a light.
  void add_met_light(const PathSegment& segment, const PathVertex& on, const Rgb& radiance) {
    double others = 0.0;
    const Vec3& direction = segment.ray.direction;
    if (camera_.size() > 1) {
      const PathVertex& before = camera_.back();
      if (!scene_.links(on.light, before.lists(scene_))) return;
      const double met = density_at(segment, on, before.position);
      const LightDensities densities = light_densities(scene_, on, before, direction);
      const double back = densities.towards / before.density;
      others = (segment.specular ? 0.0 : square(ratio(densities.chosen, met))) +
               square(ratio(densities.emitted * back, met)) * before.chain;
    }
    FoundPath path = path_of(0, camera_.size() + 1, on.light);
    path.direction = direction;
    path.end = on.position;
    path.specular = segment.specular;
    add(0, camera_.size() + 1, {on.light, on.infinitely_far}, first_,
        segment.throughput * radiance * weight(path, 0.0, others));
  }

  /// s = 1: a place on a light is chosen from the camera path's vertex t - 1.
  void choose_light(int t) {
    const PathVertex& v = camera_[t - 1];
    if (!v.joins() || t - 1 > settings_.max_depth || !wanted(1, t) || scene_.selector->empty())
      return;
    sampler_.set_dimension(kCameraDimensions + static_cast<uint32_t>(t - 2) * kPerEvent +
                           kLightChoice);
    const Vec4 u = sampler_.next_4d();
    const ListBits lists = v.lists(scene_);
    const auto selected = scene_.selector->select(v.position, v.selection_normal(), u.z, lists);
    if (!selected || !scene_.links(selected->index, lists)) return;
    const Light& light = *scene_.lights[selected->index];
    const auto sample = light.sample_direct(v.position, ray_.time, u.w, Vec2(u));
    if (!sample || is_black(sample->radiance)) return;
    const Vec3& direction = sample->direction;
    const Rgb f = v.evaluate(v.wo, direction, TransportMode::radiance);
    if (is_black(f)) return;
    const Ray shadow = v.kind == PathVertex::Kind::surface
                           ? shadow_ray(v.point, *sample)
                           : shadow_ray(v.position, *sample, ray_.time);
    const Rgb share =
        visible_share(scene_, shadow, v.around_towards(direction),
                      MediaNumbers(sampler_, t - 2, MediaNumbers::Purpose::shadow), work_);
    if (is_black(share)) return;

    PathVertex& on = met_light_;
    on.kind = PathVertex::Kind::light;
    on.position = sample->position;
    on.point.ng = sample->normal;
    on.infinitely_far = light.is_infinite();
    const double chosen =  // per solid angle; of delta lights a probability
        static_cast<double>(selected->probability) * static_cast<double>(sample->pdf);
    const double met = sample->delta ? 0.0 : v.pdf(v.wo, direction, TransportMode::radiance);
    // In the light's own measure.
    const double chosen_place =
        sample->delta ? chosen : chosen * on.per_direction(v.position, direction);
    const double emitted =
        static_cast<double>(scene_.selector->emitter_probability(selected->index)) *
        static_cast<double>(sample->pdf_place);
    const double towards = emission_density(scene_, light, on, v, direction);
    const double camera_side = square(ratio(emitted * towards, chosen_place * v.density)) *
                               sum_before(camera_, t - 1, direction, TransportMode::importance);
    FoundPath path = path_of(1, t, selected->index);
    path.direction = direction;
    path.end = on.position;
    add(1, t, {selected->index}, first_event(t, direction),
        v.throughput * f * sample->radiance * share *
            (weight(path, square(met / chosen), camera_side) / static_cast<float>(chosen)));
  }

  /// edge + beyond reverse^2 of vertex `i` of `path` where light comes to it along `from`, and
  /// `mode` is what travels from there to the vertex before.
  static double sum_before(const Subpath& path, int i, const Vec3& from, TransportMode mode) {
    const PathVertex& v = path[i];
    if (!(v.beyond > 0.0)) return v.edge;
    const double reverse = v.pdf(from, v.wo, mode) * path[i - 1].per_direction(v.position, v.wo);
    return v.edge + v.beyond * square(reverse);
  }

  void join_subpaths() {
    const int most = settings_.max_depth + 2;
    if (settings_.light_vertices >= 0) {
      const int s = settings_.light_vertices;
      const int t = settings_.camera_vertices;
      if (s >= 2 && t >= 2 && s <= light_.size() && t <= camera_.size() && s + t <= most)
        join(s, t, 1.0F);
      return;
    }
    // Numbers of the last flight that a light path could take.
    const float u = MediaNumbers(sampler_, 0xFFFF, MediaNumbers::Purpose::light_flight).next().x;
    for_chosen_joins(light_.size(), camera_.size(), most, u,
                     [&](int s, int t, float chosen) { join(s, t, chosen); });
  }

  /// Vertex s - 1 of the light path and t - 1 of the camera path, a pair that was chosen with
  /// probability 1 / `chosen`.
  void join(int s, int t, float chosen) {
    const PathVertex& y = light_[s - 1];
    const PathVertex& z = camera_[t - 1];
    if (!y.joins() || !z.joins() || !wanted(s, t)) return;
    const Vec3d way = Vec3d(y.position) - Vec3d(z.position);
    const double distance2 = glm::dot(way, way);
    if (!(distance2 > 0.0)) return;
    const Vec3 to_light = Vec3(way / std::sqrt(distance2));
    const Rgb f_camera = z.evaluate(z.wo, to_light, TransportMode::radiance);
    if (is_black(f_camera)) return;
    const Rgb f_light = y.evaluate(y.wo, -to_light, TransportMode::importance);
    if (is_black(f_light)) return;
    const MediaNumbers numbers(sampler_, s * 256 + t, MediaNumbers::Purpose::connection);
    const Rgb share = visible_share(scene_, ray_between(z, y, ray_.time),
                                    z.around_towards(to_light), numbers, work_);
    if (is_black(share)) return;
    const double to_y =
        z.pdf(z.wo, to_light, TransportMode::radiance) * y.per_direction(z.position, to_light);
    const double to_z =
        y.pdf(y.wo, -to_light, TransportMode::importance) * z.per_direction(y.position, -to_light);
    const double light_side =
        square(to_y / y.density) * sum_before(light_, s - 1, -to_light, TransportMode::radiance);
    const double camera_side =
        square(to_z / z.density) * sum_before(camera_, t - 1, to_light, TransportMode::importance);
    const float share_of_all = weight(path_of(s, t, light_[0].light), light_side, camera_side);
    add(s, t, {light_[0].light}, first_event(t, to_light),
        z.throughput * f_camera * f_light * y.throughput * share *
            (chosen * share_of_all / static_cast<float>(distance2)));
  }

  /// t = 1: vertex s - 1 of the light path is seen through a place of the lens.
  void join_lens(int s, const Vec2& lens) {
    const PathVertex& y = light_[s - 1];
    if (!y.joins() || !wanted(s, 1)) return;
    if (is_hidden_from_camera(y)) return;
    const auto seen = scene_.camera->connect(y.position, lens, ray_.time);
    if (!seen) return;
    find_places(seen->film);
    if (places_.empty()) return;
    const bool surface = y.kind == PathVertex::Kind::surface;
    if (surface && is_unseen(*y.object, y.point, seen->direction, RayKind::camera)) return;
    const Rgb f = y.evaluate(y.wo, -seen->direction, TransportMode::importance);
    if (is_black(f)) return;
    const Vec3 end = surface ? offset_position(y.point, -seen->direction) : y.position;
    const MediaNumbers numbers(sampler_, s * 256 + 1, MediaNumbers::Purpose::connection);
    const Rgb share = visible_share_from_camera(scene_, ray_between(seen->position, end, ray_.time),
                                                numbers, work_);
    if (is_black(share)) return;
    const double to_y = seen->across / film_pixels_ * y.across(seen->direction);
    const double light_side = square(to_y / y.density) *
                              sum_before(light_, s - 1, -seen->direction, TransportMode::radiance);
    FoundPath path = path_of(s, 1, light_[0].light);
    path.direction = -seen->direction;
    path.end = seen->position;
    const Rgb value = y.throughput * f * share *
                      (weight(path, light_side, 0.0) * static_cast<float>(seen->across));
    tell(s, 1, value);
    Splat splat{{}, value};
    if (work_.parts != nullptr) {
      const std::vector<SplatPart>& parts = work_.parts->splat_parts();
      splat.first_part = static_cast<uint32_t>(parts.size());
      work_.parts->add_splat(event_at(y, -seen->direction, y.wo, false), s - 1, {light_[0].light},
                             value);
      splat.parts = static_cast<uint32_t>(parts.size()) - splat.first_part;
    }
    for (const Vec2& place : places_) {
      splat.film = place;
      work_.splats.push_back(splat);
    }
  }

  /// Whether the camera does not see what scatters at `y`, or sees a hole there.
  bool is_hidden_from_camera(const PathVertex& y) const {
    if (y.kind == PathVertex::Kind::surface) {
      return y.object->holdout ||
             !meet(scene_.world->placement(y.point.object).seen_by, RayKind::camera);
    }
    return y.around.body() != nullptr && scene_.objects[y.around.body()->object].holdout;
  }

  /// The places that see what `film` sees and that pixels that are rendered may see, whatever the
  /// filter.
  void find_places(const Vec2& film) {
    const Vec2 widest_filter(17.0F);  // 16 pixels, and the half pixel around a centre
    const PixelRect& w = scene_.window;
    places_.clear();
    scene_.camera->add_places(film, Vec2(w.x0, w.y0) - widest_filter,
                              Vec2(w.x1, w.y1) + widest_filter, places_);
  }

  const IntegratorDesc& settings_;
  const Scene& scene_;
  const Ray& ray_;
  Sampler& sampler_;
  Workspace& work_;
  Subpath& camera_;
  Subpath& light_;
  std::vector<Vec2>& places_;  ///< of the film where a light path is seen
  double film_pixels_;         ///< how many samples, so light paths, a pass over the film has
  PathVertex met_light_;
  PixelSample out_;
  FirstEvent first_;  ///< that the camera path goes on from, where light is told apart
  bool albedo_noted_ = false;
};

class BdptIntegrator : public Integrator {
 public:
  explicit BdptIntegrator(const IntegratorDesc& settings) : settings_(settings) {}

  PixelSample sample(const Scene& scene, const Ray& ray, Sampler& sampler,
                     Workspace& work) const override {
    if (!work.scratch) work.scratch = std::make_unique<BdptScratch>();
    return BidirectionalSample(settings_, scene, ray, sampler, work,
                               static_cast<BdptScratch&>(*work.scratch))
        .trace();
  }

 private:
  IntegratorDesc settings_;
};

}  // namespace

std::unique_ptr<Integrator> make_bdpt_integrator(const IntegratorDesc& desc) {
  return std::make_unique<BdptIntegrator>(desc);
}

}  // namespace hyades::core
