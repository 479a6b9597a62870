#include "core/media/shell_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.h"
#include "core/media/sphere_image.h"
#include "core/textures/noise.h"

namespace hyades::core {
namespace {

float length(const Vec3& v) { return std::sqrt(glm::dot(v, v)); }

/// What the fields of a shell share.
class ShellPlace {
 public:
  explicit ShellPlace(const Shell& shell)
      : shell_(shell), image_(*shell.image, shell.turn), swirl_(shell.octaves, 2.0F, 0.5F) {}

  /// Of the image, at a place of the shell.
  Rgb color(const Vec3& p) const {
    Vec3 from = p;
    if (shell_.swirl > 0.0F) {
      Vec3 by;
      for (int a = 0; a < 3; ++a) {
        const Vec3 apart(31.7F * static_cast<float>(a), 0.0F, 0.0F);
        by[a] = swirl_.value(Vec4(p * shell_.scale + apart, shell_.time));
      }
      const float reach = length(by);
      from += by * (shell_.swirl / std::max(reach, std::sqrt(3.0F)));
    }
    return from == Vec3(0.0F) ? Rgb(0.0F) : image_.at(from);
  }

  /// The colour, no brighter than `high`.
  Rgb shine(const Vec3& p) const {
    const Rgb seen = color(p);
    const float bright = luminance(seen);
    return bright > shell_.high ? seen * (shell_.high / bright) : seen;
  }

  /// At a distance from the origin.
  float profile(float radius) const {
    if (!(radius > shell_.inner && radius < shell_.outer)) return 0.0F;
    const float h = 2.0F * (radius - shell_.inner) / (shell_.outer - shell_.inner) - 1.0F;
    return 1.0F - h * h;
  }

  float density(const Vec3& p) const {
    const float height = profile(length(p));
    return height > 0.0F ? height * mapped(luminance(color(p))) : 0.0F;
  }

  Extent density_over(const Bounds& box) const {
    const Vec3 nearest = glm::clamp(Vec3(0.0F), box.lower, box.upper);
    const Vec3 farthest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    const float near = length(nearest);
    const float far = length(farthest);
    if (near >= shell_.outer || far <= shell_.inner) return {0.0F, 0.0F};
    const float middle = 0.5F * (shell_.inner + shell_.outer);
    const float height = profile(std::clamp(middle, near, far));
    const Vec3 center = box.center();
    const float distance = length(center);
    const float radius = 0.5F * length(box.size()) + shell_.swirl;
    const float angle = radius < distance ? asin(radius / distance) : kPi;
    const Vec3 direction = distance > 0.0F ? center : Vec3(0.0F, 1.0F, 0.0F);
    return {0.0F, height * mapped(image_.greatest_luminance(direction, angle)) * (1.0F + 1e-4F)};
  }

  Bounds bounds() const { return {Vec3(-shell_.outer), Vec3(shell_.outer)}; }

 private:
  float mapped(float brightness) const {
    if (shell_.high <= shell_.low) return brightness > shell_.low ? 1.0F : 0.0F;
    return std::clamp((brightness - shell_.low) / (shell_.high - shell_.low), 0.0F, 1.0F);
  }

  Shell shell_;
  SphereImage image_;
  FractalNoise swirl_;
};

class ShellDensity final : public DensityField {
 public:
  explicit ShellDensity(std::shared_ptr<const ShellPlace> place) : place_(std::move(place)) {}
  float at(const Vec3& p) const override { return place_->density(p); }
  Extent over(const Bounds& box) const override { return place_->density_over(box); }
  Bounds bounds() const override { return place_->bounds(); }

 private:
  std::shared_ptr<const ShellPlace> place_;
};

class ShellTint final : public ColorField {
 public:
  explicit ShellTint(std::shared_ptr<const ShellPlace> place) : place_(std::move(place)) {}
  Rgb at(const Vec3& p) const override {
    const Rgb color = place_->color(p);
    const float brightest = max_component(color);
    return brightest > 0.0F ? color / brightest : Rgb(1.0F);
  }

 private:
  std::shared_ptr<const ShellPlace> place_;
};

class ShellGlow final : public ColorField {
 public:
  explicit ShellGlow(std::shared_ptr<const ShellPlace> place) : place_(std::move(place)) {}
  Rgb at(const Vec3& p) const override {
    const float height = place_->profile(length(p));
    return height > 0.0F ? place_->shine(p) * height : Rgb(0.0F);
  }

 private:
  std::shared_ptr<const ShellPlace> place_;
};

}  // namespace

ShellFields make_shell(const Shell& shell) {
  const auto place = std::make_shared<const ShellPlace>(shell);
  return {std::make_shared<ShellDensity>(place), std::make_shared<ShellTint>(place),
          std::make_shared<ShellGlow>(place)};
}

}  // namespace hyades::core
