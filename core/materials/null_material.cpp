#include <memory>
#include <optional>

#include "core/materials/delta_bsdf.h"
#include "core/materials/make_material.h"

namespace hyades::core {
namespace {

/// Straight through. Integrators step over it; as part of a mix it is sampled like any delta lobe.
class NullBsdf final : public DeltaBsdf {
 public:
  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2&,
                                   TransportMode) const override {
    return BsdfSample{
        .weight = Rgb(1.0F), .pdf = 1.0F, .wi = -wo, .delta = true, .transmitted = true};
  }

  Rgb albedo(const Vec3&) const override { return Rgb(1.0F); }
  bool is_null() const override { return true; }
};

class NullMaterial final : public Material {
 public:
  const Bsdf* bsdf_at(const SurfacePoint&, Frame&, BsdfArena& arena) const override {
    return arena.make<NullBsdf>();
  }
  bool is_null() const override { return true; }
};

class BlackMaterial final : public Material {
 public:
  const Bsdf* bsdf_at(const SurfacePoint&, Frame&, BsdfArena&) const override { return nullptr; }
};

}  // namespace

MaterialPtr make_null() { return std::make_shared<NullMaterial>(); }
MaterialPtr make_black() { return std::make_shared<BlackMaterial>(); }

}  // namespace hyades::core
