#include <memory>
#include <optional>
#include <utility>

#include "core/materials/delta_bsdf.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

class MirrorBsdf final : public DeltaBsdf {
 public:
  explicit MirrorBsdf(const Rgb& color) : color_(color) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2&,
                                   TransportMode) const override {
    return BsdfSample{.weight = color_, .pdf = 1.0F, .wi = mirrored(wo), .delta = true};
  }

  Rgb albedo(const Vec3&) const override { return color_; }

 private:
  Rgb color_;
};

class Mirror final : public Material {
 public:
  explicit Mirror(ColorParam color) : color_(std::move(color)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const Rgb color = reflectance_at(color_, point);
    return is_black(color) ? nullptr : arena.make<MirrorBsdf>(color);
  }

 private:
  ColorParam color_;
};

}  // namespace

MaterialPtr make_mirror(const ColorParam& color) { return std::make_shared<Mirror>(color); }

}  // namespace hyades::core
