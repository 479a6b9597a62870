#include <memory>
#include <utility>

#include "core/materials/params.h"
#include "core/materials/wrapped_material.h"

namespace hyades::core {
namespace {

class Cutout final : public WrappedMaterial {
 public:
  Cutout(MaterialPtr base, ScalarParam opacity)
      : WrappedMaterial(std::move(base)), opacity_(std::move(opacity)) {}

  float opacity(const SurfacePoint& point) const override {
    return fraction_at(opacity_, point) * base().opacity(point);
  }
  bool is_cutout() const override { return true; }

 private:
  ScalarParam opacity_;
};

}  // namespace

MaterialPtr make_cutout(MaterialPtr base, const ScalarParam& opacity) {
  if (!opacity.texture && !(opacity.value < 1.0F)) return base;
  return std::make_shared<Cutout>(std::move(base), opacity);
}

}  // namespace hyades::core
