#pragma once

#include <utility>

#include "core/materials/make_material.h"

namespace hyades::core {

/// A material that changes another one and is otherwise like it.
class WrappedMaterial : public Material {
 public:
  explicit WrappedMaterial(MaterialPtr base) : base_(std::move(base)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    return base_->bsdf_at(point, frame, arena);
  }
  bool is_null() const override { return base_->is_null(); }
  bool leads_inside() const override { return base_->leads_inside(); }
  float opacity(const SurfacePoint& point) const override { return base_->opacity(point); }
  bool is_cutout() const override { return base_->is_cutout(); }
  bool diffuses_evenly() const override { return base_->diffuses_evenly(); }
  float index() const override { return base_->index(); }

 protected:
  const Material& base() const { return *base_; }

 private:
  MaterialPtr base_;
};

}  // namespace hyades::core
