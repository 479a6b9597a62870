#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/elementary.h"
#include "core/media/attenuation.h"
#include "core/media/make_medium.h"
#include "core/media/shares.h"

namespace hyades::core {
namespace {

/// However short the steps asked for are.
constexpr float kMostSteps = 1 << 20;

/// Goes in equal steps, taking the density all along a step for that of one place of it, at the
/// same random part of each. Biased, for the mean of exp(-x) is more than exp of the mean.
class Marching final : public Medium {
 public:
  Marching(std::shared_ptr<const Volume> volume, FieldPlace place, const Coefficients& per_density,
           const Phase& phase, float step)
      : volume_(std::move(volume)),
        place_(std::move(place)),
        per_density_(per_density),
        extinction_(per_density.extinction()),
        phase_(phase),
        step_(step) {}

  /// As in a homogeneous medium, with depths in place of lengths.
  MediumSample sample(const Ray& ray, float t_max, const Rgb& shares,
                      const Vec4& u) const override {
    MediumSample result;
    const float chosen =
        is_black(per_density_.scattering) ? 0.0F : extinction_[choose_channel(shares, u.x).index];
    const float target = chosen > 0.0F ? -log1p(-u.y) / chosen : kInfinity;
    float depth = 0.0F;
    Vec3 at(0.0F);
    march(ray, t_max, u.z, [&](float begin, float length, const Vec3& place, float density) {
      const float more = density * length;
      if (depth + more <= target) {
        depth += more;
        return true;
      }
      result.scattered = true;
      result.t = std::min(begin + (target - depth) / density, std::nextafter(t_max, 0.0F));
      depth = target;
      at = place;
      return false;
    });
    if (is_black(per_density_.scattering)) {
      result.weight = attenuation(extinction_, depth);
      return result;
    }
    const Rgb passed = relative_attenuation(extinction_, depth, shares);
    if (!result.scattered) {
      result.weight = passed / glm::dot(shares, passed);
      return result;
    }
    const float density = glm::dot(shares, extinction_ * passed);
    if (!(density > 0.0F)) {
      result.weight = Rgb(0.0F);
      return result;
    }
    result.weight = passed * extinction_ * per_density_.albedo(*volume_, at) / density;
    return result;
  }

  Rgb transmittance(const Ray& ray, float t_max, const Vec4& u) const override {
    float depth = 0.0F;
    march(ray, t_max, u.z, [&](float, float length, const Vec3&, float density) {
      depth += density * length;
      return true;
    });
    return attenuation(extinction_, depth);
  }

  Rgb emitted(const Ray& ray, float t_max, const Vec4& u) const override {
    if (is_black(per_density_.emission)) return Rgb(0.0F);
    float depth = 0.0F;
    Rgb sum(0.0F);
    march(ray, t_max, u.z, [&](float, float length, const Vec3& place, float density) {
      const float more = density * length;
      sum += attenuation(extinction_, depth + 0.5F * more) *
             per_density_.glow(*volume_, place, density) * length;
      depth += more;
      return true;
    });
    return sum;
  }

  const Phase& phase() const override { return phase_; }

  Rgb albedo(const Vec3& position) const override {
    return per_density_.albedo(*volume_, transform_point(place_.to_field(0.0F), position));
  }

 private:
  /// Calls visit(begin, length, place, density) for each step; visit returns whether to go on.
  template <class Visit>
  void march(const Ray& ray, float t_max, float part, const Visit& visit) const {
    const FieldRay way = place_.in_field(ray);
    const auto span = volume_->majorants->inside(way.origin, way.direction, t_max);
    if (!(span.begin < span.end)) return;
    const float length = span.end - span.begin;
    const float count = std::clamp(std::ceil(length / step_), 1.0F, kMostSteps);
    const float step = length / count;
    for (float i = 0.0F; i < count; ++i) {
      const float begin = span.begin + i * step;
      const Vec3 place = way.at(begin + part * step);
      if (!visit(begin, step, place, volume_->density->at(place))) return;
    }
  }

  std::shared_ptr<const Volume> volume_;
  FieldPlace place_;
  Coefficients per_density_;
  Rgb extinction_;
  Phase phase_;
  float step_;
};

}  // namespace

MediumPtr make_marching(std::shared_ptr<const Volume> volume, const FieldPlace& place,
                        const Coefficients& per_density, const Phase& phase, float step) {
  return std::make_shared<Marching>(std::move(volume), place, per_density, phase, step);
}

}  // namespace hyades::core
