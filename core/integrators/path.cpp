#include "core/integrators/path.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/integrators/mis.h"
#include "core/materials/shaded_surface.h"

namespace hyades::core {
namespace {

// Dimensions of one bounce: two groups of four of the sampler.
enum BounceDimension : uint32_t {
  kLight = 0,  // place on it (2), which light, which part of it
  kBsdf = 4,   // direction (2), lobe, roulette
  kPerBounce = 8,
};

/// Surfaces that a ray may pass without scattering (null materials) before it counts as caught in a
/// bad mesh.
constexpr int kMaxNullCrossings = 1000;

/// A path that survives roulette less often than this would be all noise.
constexpr float kMinSurvival = 0.05F;

std::string show(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// The state of one path on its way from the camera.
class Path {
 public:
  Path(const IntegratorDesc& settings, const Scene& scene, const Ray& ray, Sampler& sampler,
       Workspace& work)
      : settings_(settings), scene_(scene), ray_(ray), sampler_(sampler), work_(work) {}

  PixelSample trace() {
    previous_.position = ray_.origin;
    int null_crossings = 0;
    while (true) {
      ++work_.rays;
      SurfacePoint point;
      if (!scene_.world->nearest(ray_, depth_ == 0 ? RayKind::camera : RayKind::other, point)) {
        add_sky();
        break;
      }
      const SceneObject& object = scene_.objects[point.object];
      if (object.material->is_null()) {
        add_emission(point, object);
        if (++null_crossings > kMaxNullCrossings) break;
        ray_ = spawn_ray(point, ray_.direction);
        ray_.time = point.time;
        continue;
      }
      if (depth_ == 0) note_first_surface(point);
      if (work_.log != nullptr) log_hit(point, object);
      add_emission(point, object);
      if (depth_ >= settings_.max_depth) break;

      work_.arena.reset();
      const ShadedSurface surface(point, *object.material, work_.arena);
      if (surface.bsdf() == nullptr) break;
      const Vec3 wo = -ray_.direction;
      if (!albedo_noted_) note_albedo(surface, wo);
      const uint32_t dimension = kCameraDimensions + static_cast<uint32_t>(depth_) * kPerBounce;
      if (surface.has_smooth()) add_direct_light(surface, wo, dimension);
      if (!scatter(surface, wo, dimension)) break;
    }
    return out_;
  }

 private:
  /// Adds `light` times the path's throughput; what came by more than one bounce may be clamped on
  /// request.
  void add(const Rgb& light, int events) {
    Rgb contribution = throughput_ * light;
    if (settings_.clamp > 0.0F && events > 1)
      contribution = glm::min(contribution, Rgb(settings_.clamp));
    out_.radiance += contribution;
    if (work_.log != nullptr && !is_black(contribution)) {
      work_.log->lines.push_back("    light arrives: " + show(contribution));
    }
  }

  /// The probability of choosing light `index` at the previous scattering event.
  float selection_probability(uint32_t index) const {
    return scene_.selector->probability(previous_.position, previous_.normal, index);
  }

  /// Weight of light that the BSDF sample found, against choosing that light.
  float bsdf_weight(uint32_t index, float light_pdf) const {
    if (previous_.specular) return 1.0F;
    return power_heuristic(previous_.pdf, selection_probability(index) * light_pdf);
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
      add(radiance * bsdf_weight(index, pdf), depth_);
    }
  }

  void add_emission(const SurfacePoint& point, const SceneObject& object) {
    if (object.light == SceneObject::kNoLight) return;
    const Light& light = *scene_.lights[object.light];
    const Rgb radiance = light.radiance(point, -ray_.direction);
    if (is_black(radiance)) return;
    const float pdf =
        previous_.specular ? 0.0F : light.pdf_direct(previous_.position, ray_.direction, point);
    add(radiance * bsdf_weight(object.light, pdf), depth_);
  }

  void add_direct_light(const ShadedSurface& surface, const Vec3& wo, uint32_t dimension) {
    if (scene_.lights.empty()) return;
    const SurfacePoint& point = surface.point();
    sampler_.set_dimension(dimension + kLight);
    const Vec4 u = sampler_.next_4d();
    const auto chosen = scene_.selector->select(point.position, point.ng, u.z);
    if (!chosen) return;
    const Light& light = *scene_.lights[chosen->index];
    const auto sample = light.sample_direct(point.position, point.time, u.w, Vec2(u));
    if (!sample || is_black(sample->radiance)) return;
    const Rgb f = surface.evaluate(wo, sample->direction, TransportMode::radiance);
    if (is_black(f)) return;

    Ray shadow = sample->distance == kInfinity ? spawn_ray(point, sample->direction)
                                               : spawn_ray_to(point, sample->position, 0.0F);
    shadow.time = point.time;
    ++work_.rays;
    if (scene_.world->occluded(shadow)) return;
    const float light_pdf = chosen->probability * sample->pdf;
    const float weight =
        sample->delta ? 1.0F
                      : power_heuristic(
                            light_pdf, surface.pdf(wo, sample->direction, TransportMode::radiance));
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("    chooses light '{}', weight {:.4g}",
                                             scene_.light_names[chosen->index], weight));
    }
    add(f * sample->radiance * (weight / light_pdf), depth_ + 1);
  }

  /// Goes on along the BSDF; false where the path ends.
  bool scatter(const ShadedSurface& surface, const Vec3& wo, uint32_t dimension) {
    sampler_.set_dimension(dimension + kBsdf);
    const Vec4 u = sampler_.next_4d();
    const auto sample = surface.sample(wo, u.z, Vec2(u), TransportMode::radiance);
    if (!sample || is_black(sample->weight)) return false;
    ++work_.bounces;
    throughput_ *= sample->weight;
    eta_scale_ *= sample->eta * sample->eta;
    ++depth_;

    if (depth_ >= settings_.roulette_depth) {
      // Without the factor of refraction, which is undone when the path leaves the glass again.
      const float keep = std::max(max_component(throughput_) * eta_scale_, kMinSurvival);
      if (keep < 1.0F) {
        if (u.w >= keep) {
          if (work_.log != nullptr) work_.log->lines.emplace_back("  ended by roulette");
          return false;
        }
        throughput_ /= keep;
      }
    }
    const SurfacePoint& point = surface.point();
    previous_.specular = sample->delta;
    previous_.pdf = sample->pdf;
    previous_.position = point.position;
    previous_.normal = point.ng;
    ray_ = spawn_ray(point, sample->wi);
    ray_.time = point.time;
    if (work_.log != nullptr) {
      work_.log->lines.push_back(fmt::format("  {} {} along {}, weight {}",
                                             sample->delta ? "specular" : "scattered",
                                             sample->transmitted ? "transmission" : "reflection",
                                             show(sample->wi), show(sample->weight)));
    }
    return true;
  }

  void note_first_surface(const SurfacePoint& point) {
    out_.alpha = 1.0F;
    out_.depth = scene_.camera->depth_of(point.position, point.time);
    out_.normal = point.ns;
  }

  void note_albedo(const ShadedSurface& surface, const Vec3& wo) {
    if (!surface.has_smooth()) return;
    out_.albedo = throughput_ * surface.bsdf()->albedo(surface.frame().to_local(wo));
    albedo_noted_ = true;
  }

  void log_hit(const SurfacePoint& point, const SceneObject& object) {
    const bool mesh = scene_.world->placement(point.object).shape.kind == Shape::Kind::mesh;
    work_.log->lines.push_back(
        fmt::format("  meets '{}'{} at {} after {:.6g} m, normal {}", object.name,
                    mesh ? fmt::format(" (triangle {})", point.primitive) : std::string(),
                    show(point.position), point.t, show(point.ns)));
  }

  /// Where the path scattered last: what light selection and MIS refer to.
  struct Previous {
    Vec3 position{0.0F};
    Vec3 normal{0.0F};
    float pdf = 0.0F;
    bool specular = true;  ///< a delta lobe, or the camera: lights could not have been chosen
  };

  const IntegratorDesc& settings_;
  const Scene& scene_;
  Ray ray_;
  Sampler& sampler_;
  Workspace& work_;
  PixelSample out_;
  Rgb throughput_{1.0F};
  Previous previous_;
  float eta_scale_ = 1.0F;
  int depth_ = 0;  ///< scattering events so far
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
