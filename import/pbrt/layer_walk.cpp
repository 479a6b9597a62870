#include "import/pbrt/layer_walk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/hash.h"
#include "core/base/warp.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"

namespace hyades::core::pbrt {
namespace {

constexpr size_t kExactLayers = 64;
constexpr int kManyWalks = 1 << 15;
constexpr int kFewWalks = 1 << 11;
constexpr int kMostEvents = 100;
constexpr float kLeastWeight = 1e-4F;

class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(mix64(seed + 1)) {}
  float next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    return static_cast<float>(mix64(state_) >> 40) * 0x1p-24F;
  }
  Vec2 pair() {
    const float x = next();
    return {x, next()};
  }

 private:
  uint64_t state_;
};

/// What becomes of light at a facet of the layer's surface.
struct Passed {
  Vec3 direction{0.0F};  ///< where it goes, in the arriving side's frame
  float weight = 0.0F;   ///< what of it other facets let by; 0: none
};

class Surface {
 public:
  Surface(float alpha, float eta) : facets_{std::max(alpha, Ggx::kLeastAlpha)}, eta_(eta) {
    smooth_ = alpha < Ggx::kLeastAlpha;
  }

  Vec3 facet(const Vec3& wo, const Vec2& u) const {
    return smooth_ ? Vec3(0.0F, 0.0F, 1.0F) : facets_.sample_normal(wo, u);
  }

  DielectricInterface meeting(const Vec3& wo, const Vec3& m) const {
    return fresnel_dielectric(std::clamp(glm::dot(wo, m), 0.0F, 1.0F), eta_);
  }

  Passed reflect(const Vec3& wo, const Vec3& m) const {
    const Vec3 wi = reflected(wo, m);
    return wi.z > 0.0F ? Passed{wi, seen(wo, wi)} : Passed{};
  }

  Passed refract(const Vec3& wo, const Vec3& m, float cos_t) const {
    const Vec3 wi = m * (glm::dot(wo, m) / eta_ - cos_t) - wo / eta_;
    return wi.z < 0.0F ? Passed{wi, seen(wo, {wi.x, wi.y, -wi.z})} : Passed{};
  }

 private:
  float seen(const Vec3& wo, const Vec3& wi) const {
    return smooth_ ? 1.0F : facets_.both_visible(wo, wi) / facets_.visible(wo);
  }

  Ggx facets_;
  float eta_;
  bool smooth_;
};

/// A direction at Henyey and Greenstein's angle from `w`.
Vec3 scattered(const Vec3& w, float g, const Vec2& u) {
  float cosine = 1.0F - 2.0F * u.x;
  if (std::fabs(g) > 1e-3F) {
    const float part = (1.0F - g * g) / (1.0F - g + 2.0F * g * u.x);
    cosine = std::clamp((1.0F + g * g - part * part) / (2.0F * g), -1.0F, 1.0F);
  }
  const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
  const float angle = 2.0F * kPi * u.y;
  const Vec3 across = std::fabs(w.z) < 0.9F ? Vec3(0.0F, 0.0F, 1.0F) : Vec3(1.0F, 0.0F, 0.0F);
  const Vec3 x = glm::normalize(glm::cross(across, w));
  const Vec3 y = glm::cross(w, x);
  return glm::normalize(x * (sine * std::cos(angle)) + y * (sine * std::sin(angle)) + w * cosine);
}

class Walk {
 public:
  Walk(const CoatLayer& layer, uint64_t seed)
      : layer_(layer),
        above_(layer.alpha, layer.eta),
        below_(layer.alpha, 1.0F / layer.eta),
        numbers_(seed) {}

  /// Calls `escape(hits, scatterings, share)` for whatever of one walk comes out above.
  template <class Escapes>
  void run(const Escapes& escape) {
    const Vec3 wo = square_to_cosine_hemisphere(numbers_.pair());
    const Vec3 m = above_.facet(wo, numbers_.pair());
    const DielectricInterface border = above_.meeting(wo, m);
    if (!go(above_.refract(wo, m, border.cos_t), false)) return;
    weight_ *= 1.0F - border.reflectance;
    height_ = layer_.thickness;
    for (int event = 0; event < std::min(layer_.events, kMostEvents); ++event) {
      if (!(std::fabs(direction_.z) > 0.0F) || !(weight_ > kLeastWeight)) return;
      if (scatters_within()) continue;
      if (direction_.z < 0.0F) {
        height_ = 0.0F;
        ++hits_;
        direction_ = square_to_cosine_hemisphere(numbers_.pair());
        continue;
      }
      height_ = layer_.thickness;
      // As the surface sees it from within: turned over.
      const Vec3 from(-direction_.x, -direction_.y, direction_.z);
      const Vec3 facet = below_.facet(from, numbers_.pair());
      const DielectricInterface meeting = below_.meeting(from, facet);
      const Passed out = below_.refract(from, facet, meeting.cos_t);
      const float through = weight_ * (1.0F - meeting.reflectance) * out.weight;
      if (through > 0.0F) escape(hits_, scatterings_, through);
      weight_ *= meeting.reflectance;
      if (!go(below_.reflect(from, facet), true)) return;
    }
  }

 private:
  bool go(const Passed& passed, bool turned) {
    direction_ = turned ? Vec3(passed.direction.x, passed.direction.y, -passed.direction.z)
                        : passed.direction;
    weight_ *= passed.weight;
    return passed.weight > 0.0F;
  }

  /// Whether something happens between the surfaces; if not, what they let through is counted.
  bool scatters_within() {
    if (!layer_.scatters) {
      weight_ *= std::exp(-layer_.thickness / std::fabs(direction_.z));
      return false;
    }
    const float way = -std::log(1.0F - numbers_.next()) * direction_.z;
    const float next = height_ + way;
    if (!(next > 0.0F && next < layer_.thickness)) return false;
    height_ = next;
    ++scatterings_;
    direction_ = scattered(direction_, layer_.g, numbers_.pair());
    return true;
  }

  const CoatLayer& layer_;
  Surface above_;
  Surface below_;
  Numbers numbers_;
  Vec3 direction_{0.0F};
  float height_ = 0.0F;
  float weight_ = 1.0F;
  size_t hits_ = 0;
  size_t scatterings_ = 0;
};

}  // namespace

LayerAnswer::LayerAnswer(const CoatLayer& layer, int walks) {
  for (int i = 0; i < walks; ++i) {
    Walk(layer, static_cast<uint64_t>(i)).run([&](size_t hits, size_t scatterings, float share) {
      if (shares_.size() <= hits) shares_.resize(hits + 1);
      std::vector<float>& row = shares_[hits];
      if (row.size() <= scatterings) row.resize(scatterings + 1);
      row[scatterings] += share / static_cast<float>(walks);
    });
  }
}

float LayerAnswer::factor(size_t hits, float albedo) const {
  if (hits >= shares_.size()) return 0.0F;
  float sum = 0.0F;
  for (size_t m = shares_[hits].size(); m-- > 0;) sum = sum * albedo + shares_[hits][m];
  return sum;
}

float LayerAnswer::share(float base, float albedo) const {
  float sum = 0.0F;
  for (size_t k = shares_.size(); k-- > 0;) sum = sum * base + factor(k, albedo);
  return sum;
}

const LayerAnswer& LayerAnswers::of(const CoatLayer& layer) {
  const auto found = known_.find(layer);
  if (found != known_.end()) return found->second;
  const int walks = known_.size() < kExactLayers ? kManyWalks : kFewWalks;
  return known_.emplace(layer, LayerAnswer(layer, walks)).first->second;
}

}  // namespace hyades::core::pbrt
