#pragma once

#include <cmath>
#include <vector>

#include "core/integrators/found_path.h"
#include "core/integrators/light_path.h"
#include "core/scene/scene.h"

namespace hyades::test {

/// A vertex of a whole path.
struct PathPlace {
  core::Vec3 position{0.0F};
  core::Vec3 normal{0.0F};                   ///< zero: none
  const core::PathVertex* vertex = nullptr;  ///< where light scatters
  bool specular = false;
};

/// The densities with which all strategies of bidirectional path tracing find one path, by brute
/// force: out of its places, from the light to the lens, and the densities of lights, materials,
/// phase functions and the camera. What core::PathVertex says of weights holds, else nothing is
/// shared with the code that computes them on the way.
class PathDensities {
 public:
  PathDensities(const core::Scene& scene, const core::FoundPath& path)
      : scene_(scene), light_(*scene.lights[path.light_index]), index_(path.light_index) {
    const bool from_end = path.s < 2;
    places_.emplace_back();
    if (!from_end) places_[0].position = path.light[0].position;
    if (from_end) places_[0].position = path.end;
    for (int i = 1; i < path.s; ++i) {
      add(path.light[i], i + 1 < path.s && path.light[i + 1].edge == 0.0);
    }
    const int last = path.s == 0 ? path.t - 2 : path.t - 1;
    for (int i = last; i > 0; --i) {
      add(path.camera[i], i < last ? path.camera[i + 1].edge == 0.0 : path.specular);
    }
    places_.emplace_back();
    places_.back().position = path.t == 1 ? path.end : path.camera[0].position;
    if (size() == 2) return;
    to_light_ =
        light_.is_infinite() ? (from_end ? path.direction : path.light[1].wo) : direction(1, 0);
    clear_ = find_light() && is_clear();
  }

  int size() const { return static_cast<int>(places_.size()); }

  /// Whether floats are good enough to say what its densities are.
  bool clear() const { return clear_; }

  /// The weight of the strategy with `s` light vertices, by the power heuristic.
  double weight(int s) const {
    if (size() == 2) return 1.0;
    double sum = 0.0;
    for (int i = 0; i < size(); ++i) sum += square(density(i));
    return square(density(s)) / sum;
  }

  bool possible(int s) const {
    if (s == 0) return !light_.is_delta();
    if (s < size() - 1 && places_[static_cast<size_t>(s)].specular) return false;
    return s == 1 || !places_[static_cast<size_t>(s) - 1].specular;
  }

 private:
  static double square(double x) { return x * x; }
  const PathPlace& at(int i) const { return places_[static_cast<size_t>(i)]; }

  void add(const core::PathVertex& v, bool specular) {
    const bool surface = v.kind == core::PathVertex::Kind::surface;
    places_.push_back({v.position, surface ? v.point.ng : core::Vec3(0.0F), &v, specular});
  }

  core::Vec3 direction(int from, int to) const {
    if (to == 0 && light_.is_infinite()) return to_light_;
    return core::Vec3(
        glm::normalize(core::Vec3d(at(to).position) - core::Vec3d(at(from).position)));
  }

  /// The light's place as rays find it; false where they do not, or look at it edge-on.
  bool find_light() {
    if (light_.is_infinite() || light_.is_delta()) return true;
    const float far = glm::length(at(0).position - at(1).position);
    core::Ray ray{at(1).position, to_light_};
    for (float gone = 0.0F; gone < 1.01F * far;) {
      const auto hit = scene_.world->intersect(ray, core::RayKind::diffuse);
      if (!hit) break;
      const core::SurfacePoint point = scene_.world->surface(ray, *hit);
      gone += point.t;
      if (scene_.objects[point.object].light == index_ && std::abs(gone - far) < 1e-3F * far) {
        on_ = point;
        places_[0].normal = point.ng;
        return std::abs(glm::dot(point.ng, to_light_)) > 0.05F;
      }
      ray = core::spawn_ray(point, to_light_);
    }
    return false;
  }

  /// A density per solid angle at `from` in the measure of place `to`.
  double measure(int from, int to) const {
    if (to == 0 && light_.is_infinite()) return 1.0;
    const core::Vec3d way = core::Vec3d(at(to).position) - core::Vec3d(at(from).position);
    const double distance2 = glm::dot(way, way);
    const double cosine =
        at(to).normal == core::Vec3(0.0F)
            ? 1.0
            : std::abs(glm::dot(core::Vec3d(at(to).normal), way)) / std::sqrt(distance2);
    return cosine / distance2;
  }

  /// Solid angle on the side of the light over that of the camera at a specular place: what
  /// refraction leaves as it is is n^2 cos dw, and n sin (Snell).
  double refracted(int j) const {
    const core::Vec3d n(at(j).vertex->surface->frame().n);
    const core::Vec3d to_camera(direction(j, j + 1));
    const core::Vec3d to_light(direction(j, j - 1));
    const double cos_o = glm::dot(n, to_camera);
    const double cos_i = glm::dot(n, to_light);
    if (cos_o * cos_i > 0.0) return 1.0;
    return (1.0 - cos_i * cos_i) / (1.0 - cos_o * cos_o) * std::abs(cos_o / cos_i);
  }

  /// Directions between places that are near each other, cosines near 0 and sines near 0 are not
  /// known to 1e-5 from places in float.
  bool is_clear() const {
    for (int j = 1; j + 1 < size(); ++j) {
      const core::Vec3d way = core::Vec3d(at(j).position) - core::Vec3d(at(j + 1).position);
      if (!(glm::length(way) > 0.05)) return false;
      const auto cosine = [&](const core::Vec3& normal, int to) {
        return std::abs(glm::dot(normal, direction(j, to)));
      };
      for (const int to : {j - 1, j + 1}) {
        if (at(j).normal != core::Vec3(0.0F) && cosine(at(j).normal, to) < 0.05F) return false;
        if (at(j).specular && cosine(at(j).vertex->surface->frame().n, to) > 0.99F) return false;
      }
    }
    return light_.is_infinite() || glm::length(at(1).position - at(0).position) > 0.05F;
  }

  /// Density with which a camera path chooses place `j`.
  double by_camera(int j) const {
    const int from = j + 1;
    if (from == size() - 1) {
      const auto pixels = static_cast<double>(scene_.window.area());
      const double density =
          static_cast<double>(scene_.camera->film_density(direction(from, j), 0.0F)) / pixels;
      if (!scene_.camera->rays_are_parallel()) return density * measure(from, j);
      const bool on_surface = at(j).normal != core::Vec3(0.0F);
      return density * (on_surface ? std::abs(glm::dot(at(j).normal, direction(from, j))) : 1.0F);
    }
    const PathPlace& v = at(from);
    const double pdf = v.specular ? 1.0
                                  : v.vertex->pdf(direction(from, from + 1), direction(from, j),
                                                  core::TransportMode::radiance);
    return pdf * measure(from, j);
  }

  /// Density with which a light path chooses place `j`, where it begins at the light.
  double by_light(int j) const {
    if (j == 0) {
      return static_cast<double>(scene_.selector->emitter_probability(index_)) *
             static_cast<double>(light_.pdf_place(on_, to_light_));
    }
    if (j == 1) {
      if (light_.is_infinite()) {
        core::PathVertex end;
        end.infinitely_far = true;
        core::PathVertex anywhere;
        anywhere.kind = core::PathVertex::Kind::medium;
        const double across = core::emission_density(scene_, light_, end, anywhere, to_light_);
        return at(1).normal == core::Vec3(0.0F)
                   ? across
                   : across * std::abs(static_cast<double>(glm::dot(at(1).normal, to_light_)));
      }
      return static_cast<double>(light_.pdf_outward(at(0).normal, -to_light_)) * measure(0, 1);
    }
    const PathPlace& v = at(j - 1);
    const double pdf = v.specular ? refracted(j - 1)
                                  : v.vertex->pdf(direction(j - 1, j - 2), direction(j - 1, j),
                                                  core::TransportMode::importance);
    return pdf * measure(j - 1, j);
  }

  /// Density with which a light is chosen from the place next to it.
  double chosen() const {
    const double selected =
        static_cast<double>(scene_.selector->probability(at(1).position, at(1).normal, index_));
    if (light_.is_delta()) return selected;
    return selected * static_cast<double>(light_.pdf_direct(at(1).position, to_light_, on_)) *
           measure(1, 0);
  }

  double density(int s) const {
    if (!possible(s)) return 0.0;
    double product = 1.0;
    for (int j = 0; j < s; ++j) product *= s == 1 ? chosen() : by_light(j);
    for (int j = s; j < size() - 1; ++j) product *= by_camera(j);
    return product;
  }

  const core::Scene& scene_;
  const core::Light& light_;
  uint32_t index_;
  std::vector<PathPlace> places_;
  core::Vec3 to_light_{0.0F};  ///< from the place next to the light
  core::SurfacePoint on_;
  bool clear_ = true;
};

}  // namespace hyades::test
