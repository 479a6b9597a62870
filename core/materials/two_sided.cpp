#include <memory>
#include <optional>
#include <utility>

#include "core/materials/local.h"
#include "core/materials/make_layers.h"
#include "core/materials/turned_bsdf.h"

namespace hyades::core {
namespace {

/// Null parts are black.
class TwoSidedBsdf final : public Bsdf {
 public:
  TwoSidedBsdf(const Bsdf* front, const Bsdf* back) : front_(front), back_(back) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    const Bsdf* seen = seen_from(wo);
    return seen != nullptr && same_side(wo, wi) ? seen->evaluate(wo, wi, mode) : Rgb(0.0F);
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    const Bsdf* seen = seen_from(wo);
    return seen != nullptr && same_side(wo, wi) ? seen->evaluate_diffuse(wo, wi) : Rgb(0.0F);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    const Bsdf* seen = seen_from(wo);
    return seen != nullptr && same_side(wo, wi) ? seen->pdf(wo, wi, mode) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Bsdf* seen = seen_from(wo);
    if (seen == nullptr) return std::nullopt;
    auto s = seen->sample(wo, lobe, u, mode);
    return s && !s->transmitted ? s : std::nullopt;
  }

  Rgb albedo(const Vec3& wo) const override {
    const Bsdf* seen = seen_from(wo);
    return seen != nullptr ? seen->albedo(wo) : Rgb(0.0F);
  }

  Spread spread(float outer) const override {
    const Bsdf* seen = outer < 0.0F ? back_ : front_;
    return seen != nullptr ? seen->spread(outer) : Spread();
  }

  bool has_smooth() const override {
    return (front_ != nullptr && front_->has_smooth()) || (back_ != nullptr && back_->has_smooth());
  }

 private:
  const Bsdf* seen_from(const Vec3& wo) const { return wo.z < 0.0F ? back_ : front_; }

  const Bsdf* front_;
  const Bsdf* back_;
};

class TwoSided final : public Material {
 public:
  TwoSided(MaterialPtr front, MaterialPtr back)
      : front_(std::move(front)), back_(std::move(back)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    const Bsdf* front = bsdf_in_frame(*front_, point, frame, arena);
    const Bsdf* back = bsdf_in_frame(*back_, point, frame, arena);
    if (front == nullptr && back == nullptr) return nullptr;
    return arena.make<TwoSidedBsdf>(front, back);
  }
  bool diffuses_evenly() const override {
    return front_->diffuses_evenly() && back_->diffuses_evenly();
  }

 private:
  MaterialPtr front_;
  MaterialPtr back_;
};

}  // namespace

MaterialPtr make_two_sided(MaterialPtr front, MaterialPtr back) {
  return std::make_shared<TwoSided>(std::move(front), std::move(back));
}

}  // namespace hyades::core
