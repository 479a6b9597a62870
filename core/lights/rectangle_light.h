#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/geometry/world.h"
#include "core/lights/area_light.h"

namespace hyades::core {

/// A rectangle in world space: corner + a * edge[0] + b * edge[1], a and b in [0, 1].
struct Rectangle {
  Vec3d corner{0.0};
  Vec3d edge[2] = {Vec3d(0.0), Vec3d(0.0)};  ///< at right angles
  Vec3 ng{0.0F};                             ///< unit, the outer side
  float clearance = 0.0F;                    ///< SurfacePoint::clearance, the largest on it
  /// Of triangle 0 the corners at (a, b) = (0, 0), (1, 0), (0, 1); of triangle 1 those at (1, 1),
  /// (0, 1), (1, 0).
  std::array<std::array<int, 3>, 2> corners{};
};

/// The rectangle that placement `object` is: a still mesh of two triangles. Nothing where it is
/// something else.
std::optional<Rectangle> find_rectangle(const World& world, uint32_t object);

struct SphericalRectangle;

/// A rectangle that gives off light, chosen uniformly by the solid angle it covers where that is
/// large (Urena, Fajardo & King 2013, "An Area-Preserving Parametrization for Spherical
/// Rectangles"), by area where it is small and the two are much the same. Where its emission varies
/// by brightness; nearby, half of the time by solid angle.
class RectangleLight : public AreaLight {
 public:
  /// Placement `object` of `world`, which is `rectangle`; `area` when the shutter opens.
  RectangleLight(const World& world, uint32_t object, const Rectangle& rectangle,
                 const SurfaceEmission& emission, double area);

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const override;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const override;
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const override;

 protected:
  std::optional<Place> choose_place(float time, float pick, const Vec2& u) const override;

 private:
  RectangleLight(const World& world, uint32_t object, const Rectangle& rectangle,
                 const SurfaceEmission& emission, double area, BrightnessGrid bright);

  /// Whether it may cover a large solid angle, seen from where its corner is at (x0, y0, z0) along
  /// its edges.
  bool is_near(double x0, double y0, double z0) const;

  float pdf_area() const { return static_cast<float>(1.0 / (width_ * height_)); }

  /// u = (0, 0) is the corner.
  Vec3 place_at(const Vec2& u) const;

  /// Where the emission varies: the place at (a, b) with the density of its being chosen.
  Place place_on(const Vec2& at, float time) const;

  /// A place seen from `from`, as sample_direct() chooses one, where the emission varies.
  std::optional<LightSample> sample_bright(const Vec3& from, float time,
                                           const std::optional<SphericalRectangle>& seen,
                                           const Vec2& u) const;

  /// The view of it from `from`; nothing where it covers too little to be chosen by solid angle.
  std::optional<SphericalRectangle> seen_nearby(const Vec3& from) const;

  const World& world_;
  uint32_t object_;
  Rectangle rectangle_;
  Vec3d x_;  ///< unit, along edge[0]
  Vec3d y_;  ///< unit, along edge[1]
  Vec3d z_;  ///< x cross y
  double width_;
  double height_;
  BrightnessGrid bright_;  ///< over (a, b); empty where the emission does not vary
};

/// The surface point at place `at`, (a, b), of `rectangle`, which is placement `object` of `world`.
SurfacePoint rectangle_point(const World& world, uint32_t object, const Rectangle& rectangle,
                             const Vec2& at, float time);

}  // namespace hyades::core
