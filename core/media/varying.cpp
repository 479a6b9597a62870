#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "core/base/elementary.h"
#include "core/media/collision_numbers.h"
#include "core/media/field_place.h"
#include "core/media/make_medium.h"
#include "core/media/shares.h"
#include "core/media/volume.h"

namespace hyades::core {
namespace {

/// A way that has met as many possible collisions ends in the dark: no walk is endless, whatever
/// densities a job asks for. A way of an optical thickness (by the bounds of the field) below half
/// a million never gets there.
constexpr int kMostCollisions = 1 << 20;

/// A channel that carries less than this on a shadow ray is a case for roulette.
constexpr double kFaint = 0.05;

/// How many looks a glow gets that nothing absorbs, on average over the part of a way in the
/// volume.
constexpr double kGlances = 4.0;

/// exp(-depth) of depth >= 0.
double decay(double depth) { return depth < 700.0 ? elementary::exp_finite(-depth) : 0.0; }

enum class Purpose : uint64_t { flight = 1, transmittance = 2, emission = 3 };

/// A medium whose coefficients are those of a colour times a density that varies in space, found by
/// null-collision tracking: collisions are proposed as if the density were everywhere that of the
/// volume's bounds, and turn out to be real in proportion to the density there (Woodcock et al.
/// 1965).
class Varying final : public Medium {
 public:
  Varying(std::shared_ptr<const Volume> volume, const FieldPlace& place,
          const Coefficients& per_density, const Phase& phase)
      : volume_(std::move(volume)),
        place_(place),
        per_density_(per_density),
        extinction_(per_density.extinction()),
        phase_(phase),
        grey_(extinction_.x == extinction_.y && extinction_.y == extinction_.z),
        scatters_(!is_black(per_density.scattering)),
        emits_(!is_black(per_density.emission)) {}

  /// Delta tracking in one channel, chosen by what the path carries. The density with which another
  /// channel would have gone the same way differs in the rate of proposals alone (a proposal is
  /// real with the same probability in all): rate^collisions exp(-rate passed). The weight is the
  /// balance heuristic over channels (Miller, Georgiev and Jarosz 2019, "A null-scattering path
  /// integral formulation of light transport", section 5.3).
  MediumSample sample(const Ray& ray, float t_max, const Rgb& shares,
                      const Vec4& u) const override {
    MediumSample result;
    if (!scatters_) {
      result.weight = transmittance(ray, t_max, u);
      return result;
    }
    const FieldRay way = place_.in_field(ray);
    const double rate = extinction_[choose_channel(shares, u.x).index];
    CollisionNumbers numbers(u, static_cast<uint64_t>(Purpose::flight));
    // As a length times a density; the first one is of the numbers that are well spread in a pixel.
    double to_go = rate > 0.0 ? -double{log1p(-u.y)} / rate : double{kInfinity};
    double passed = 0.0;  // majorant density times length
    int collisions = 0;
    float place = 0.0F;
    const DensityField& density = *volume_->density;
    volume_->majorants->walk(
        way.origin, way.direction, t_max, [&](float begin, float end, const Extent& bound) {
          const double majorant = bound.greatest;
          double t = begin;
          while (true) {
            const double left = majorant * (double{end} - t);
            if (!(to_go < left)) {
              to_go -= left;
              passed += left;
              return true;
            }
            t += to_go / majorant;
            passed += to_go;
            place = static_cast<float>(t);
            if (++collisions >= kMostCollisions) return false;
            const double threshold = numbers.uniform() * majorant;
            if (threshold < bound.least || threshold < density.at(way.at(place))) {
              result.scattered = true;
              return false;
            }
            to_go = numbers.exponential() / rate;
          }
        });
    if (collisions >= kMostCollisions) {
      result.weight = Rgb(0.0F);
      return result;
    }
    result.weight = over_all_channels(shares, collisions, passed);
    if (!result.scattered) return result;
    result.t = std::min(place, std::nextafter(t_max, 0.0F));
    result.weight *= per_density_.albedo(*volume_, way.at(result.t));
    return result;
  }

  /// Ratio tracking of what exceeds the least density of each cell, which itself is taken off in
  /// closed form (Novak, Selle and Jarosz 2014, "Residual ratio tracking for estimating attenuation
  /// in participating media").
  Rgb transmittance(const Ray& ray, float t_max, const Vec4& u) const override {
    const FieldRay way = place_.in_field(ray);
    CollisionNumbers numbers(u, static_cast<uint64_t>(Purpose::transmittance));
    Carried carried;
    int collisions = 0;
    const DensityField& density = *volume_->density;
    volume_->majorants->walk(
        way.origin, way.direction, t_max, [&](float begin, float end, const Extent& bound) {
          if (bound.least > 0.0F)
            lose(carried, double{bound.least} * (double{end} - double{begin}));
          const double spread = double{bound.greatest} - double{bound.least};
          double t = begin;
          while (true) {
            if (!(greatest_extinction(carried) * spread > 0.0)) return true;
            if (!spare_or_end(carried, numbers)) return false;
            const double rate = greatest_extinction(carried) * spread;
            t += numbers.exponential() / rate;
            if (t >= double{end}) return true;
            if (++collisions >= kMostCollisions) {
              carried = {0.0, 0.0, 0.0};
              return false;
            }
            const double excess =
                std::clamp(double{density.at(way.at(static_cast<float>(t)))} - double{bound.least},
                           0.0, spread);
            for (int c = 0; c < 3; ++c) {
              carried[static_cast<size_t>(c)] *= 1.0 - double{extinction_[c]} * excess / rate;
            }
          }
        });
    return to_rgb(carried);
  }

  /// Looks at places of random density (as many as collisions are proposed, and a few more, so that
  /// thin flames are not missed) and adds up what is given off there, each times an estimate by
  /// ratio tracking of what gets from there to the ray's origin.
  Rgb emitted(const Ray& ray, float t_max, const Vec4& u) const override {
    if (!emits_) return Rgb(0.0F);
    const FieldRay way = place_.in_field(ray);
    const auto span = volume_->majorants->inside(way.origin, way.direction, t_max);
    if (!(span.begin < span.end)) return Rgb(0.0F);
    const double glances = kGlances / (double{span.end} - double{span.begin});
    CollisionNumbers numbers(u, static_cast<uint64_t>(Purpose::emission));
    Carried carried;
    std::array<double, 3> sum{};
    int collisions = 0;
    const DensityField& density = *volume_->density;
    volume_->majorants->walk(
        way.origin, way.direction, t_max, [&](float begin, float end, const Extent& bound) {
          if (bound.greatest == 0.0F && volume_->glow == nullptr) return true;
          double t = begin;
          while (true) {
            if (!spare_or_end(carried, numbers)) return false;
            const double rate = greatest_extinction(carried) * double{bound.greatest} + glances;
            t += numbers.exponential() / rate;
            if (t >= double{end}) return true;
            if (++collisions >= kMostCollisions) return false;
            const Vec3 place = way.at(static_cast<float>(t));
            const float dense = std::min(density.at(place), bound.greatest);
            const Rgb glow = per_density_.glow(*volume_, place, dense);
            for (int c = 0; c < 3; ++c) {
              const auto i = static_cast<size_t>(c);
              sum[i] += carried[i] * double{glow[c]} / rate;
              carried[i] *= 1.0 - double{extinction_[c]} * double{dense} / rate;
            }
          }
        });
    return to_rgb(sum);
  }

  const Phase& phase() const override { return phase_; }

  Rgb albedo(const Vec3& position) const override {
    return per_density_.albedo(*volume_, transform_point(place_.to_field(0.0F), position));
  }

 private:
  /// What is left in each channel.
  struct Carried : std::array<double, 3> {
    Carried(double r = 1.0, double g = 1.0, double b = 1.0) : std::array<double, 3>{r, g, b} {}
  };

  static Rgb to_rgb(const std::array<double, 3>& x) {
    return {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
  }

  void lose(Carried& carried, double passed) const {
    for (int c = 0; c < 3; ++c) {
      carried[static_cast<size_t>(c)] *= decay(double{extinction_[c]} * passed);
    }
  }

  /// Of the channels that still carry something.
  double greatest_extinction(const Carried& carried) const {
    double greatest = 0.0;
    for (int c = 0; c < 3; ++c) {
      if (carried[static_cast<size_t>(c)] > 0.0) {
        greatest = std::max(greatest, double{extinction_[c]});
      }
    }
    return greatest;
  }

  /// Lets each faint channel either end or carry as much as is worth going on with. False where
  /// none is left.
  static bool spare_or_end(Carried& carried, CollisionNumbers& numbers) {
    bool any = false;
    double chance = -1.0;
    for (double& x : carried) {
      if (x > 0.0 && x < kFaint) {
        if (chance < 0.0) chance = numbers.uniform();
        x = chance * kFaint < x ? kFaint : 0.0;
      }
      any = any || x > 0.0;
    }
    return any;
  }

  /// The density of this way in each channel over the mean of those by `shares`, which add up to 1.
  Rgb over_all_channels(const Rgb& shares, int collisions, double passed) const {
    Rgb weight(0.0F);
    if (grey_) {
      for (int c = 0; c < 3; ++c) weight[c] = shares[c] > 0.0F ? 1.0F : 0.0F;
      return weight;
    }
    // Logarithms relative to the likeliest channel: nothing overflows.
    std::array<double, 3> log_density{};
    double likeliest = -double{kInfinity};
    for (int c = 0; c < 3; ++c) {
      if (!(shares[c] > 0.0F)) continue;
      double& l = log_density[static_cast<size_t>(c)];
      const double sigma = extinction_[c];
      if (collisions > 0) {
        l = sigma > 0.0 ? collisions * elementary::log_finite(sigma) : -double{kInfinity};
      }
      l -= sigma * passed;
      likeliest = std::max(likeliest, l);
    }
    double mean = 0.0;
    std::array<double, 3> density{};
    for (int c = 0; c < 3; ++c) {
      if (!(shares[c] > 0.0F)) continue;
      const auto i = static_cast<size_t>(c);
      density[i] = decay(likeliest - log_density[i]);
      mean += double{shares[c]} * density[i];
    }
    for (int c = 0; c < 3; ++c) {
      weight[c] = static_cast<float>(density[static_cast<size_t>(c)] / mean);
    }
    return weight;
  }

  std::shared_ptr<const Volume> volume_;
  FieldPlace place_;
  Coefficients per_density_;
  Rgb extinction_;
  Phase phase_;
  bool grey_;
  bool scatters_;
  bool emits_;
};

}  // namespace

MediumPtr make_varying(std::shared_ptr<const Volume> volume, const FieldPlace& place,
                       const Coefficients& per_density, const Phase& phase) {
  return std::make_shared<Varying>(std::move(volume), place, per_density, phase);
}

}  // namespace hyades::core
