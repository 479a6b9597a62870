#pragma once

#include <memory>
#include <optional>

#include "core/base/vec.h"
#include "core/lights/light.h"

namespace hyades::core {

/// Light from a single place, more of it in some directions than in others. Directions are unit, in
/// the world, away from the light.
class PointSource : public Light {
 public:
  /// `intensity`: [W/sr] where value() is 1.
  PointSource(const Vec3& position, const Rgb& intensity)
      : position_(position), intensity_(intensity) {}

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const final;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const final;
  Rgb radiance(const SurfacePoint& on, const Vec3& outward) const final;
  bool is_delta() const final { return true; }
  std::optional<LightBounds> bounds() const final;
  std::optional<Vec3> middle() const final { return position_; }
  std::optional<EmissionSample> sample_emission(float time, float pick, const Vec2& place,
                                                const Vec2& direction) const final;
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const final;
  float pdf_outward(const Vec3& normal, const Vec3& outward) const final;

  const Vec3& position() const { return position_; }
  const Rgb& intensity() const { return intensity_; }

  /// What goes in a direction, of intensity().
  virtual Rgb value(const Vec3& direction) const = 0;
  /// A direction, rounded to length 1 afterwards, with density pdf() per solid angle. Only where
  /// power() is above 0.
  virtual Vec3 choose(const Vec2& u) const = 0;
  virtual float pdf(const Vec3& direction) const = 0;
  /// All directions that are lit.
  virtual DirectionCone cone() const = 0;

 private:
  Vec3 position_;
  Rgb intensity_;
};

using PointSourcePtr = std::shared_ptr<const PointSource>;

}  // namespace hyades::core
