#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/job/fields.h"
#include "core/job/source.h"

namespace hyades::core {

/// A lens that blurs what is out of focus.
struct ApertureDesc {
  Animated<float> radius{0.0F};           ///< 0: pinhole
  std::optional<Animated<float>> f_stop;  ///< radius = focal length / (2 f_stop), 24 mm sensor
  int blades = 0;                         ///< 0: round, else >= 3
  Animated<float> rotation{0.0F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated(KeyName{"radius", "aperture_radius"}, self.radius, kNotNegative.in("length"));
    visit.animated("f_stop", self.f_stop, kPositive);
    visit.integer(KeyName{"blades", "aperture_blades"}, self.blades, 0, 64);
    visit.animated(KeyName{"rotation", "aperture_rotation"}, self.rotation,
                   kAnyNumber.in("degrees"));
  }
};

/// How bright pictures are, as on a camera: it adds to the exposures of outputs.
struct ExposureDesc {
  float iso = 100.0F;
  float shutter = 0.008F;
  float f_number = 16.0F;
  float efficacy = 97.4F;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.number("iso", self.iso, {1.0, 1e7});
    visit.number("shutter", self.shutter, Range{1e-9, 1e6}.in("s"));
    visit.number("f_number", self.f_number, {0.01, 1e4});
    visit.number("efficacy", self.efficacy, Range{1e-3, 683.0}.in("lm/W"));
  }
};

inline const std::array<std::string, 3> kCameraTypes = {"perspective", "orthographic",
                                                        "equirectangular"};

struct CameraDesc {
  std::string type = kCameraTypes[0];
  Animated<Vec3> look_from{Vec3(0.0F, 1.0F, 5.0F)};
  Animated<Vec3> look_at{Vec3(0.0F)};
  Animated<Vec3> up{Vec3(0.0F, 1.0F, 0.0F)};
  Animated<float> fov{40.0F};        ///< perspective: vertical
  Animated<Vec2> shift{Vec2(0.0F)};  ///< perspective: to the right, up; of width and height
  Animated<float> height{5.0F};      ///< orthographic: of what the picture shows
  ApertureDesc aperture;             ///< no panoramas
  std::optional<Animated<float>> focus_distance;  ///< along the view axis; absent: to look_at
  std::string focus_object;                       ///< focus on this object's centre
  SourceLocation focus_where;                     ///< of its name

  /// The keys of its type.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated("look_from", self.look_from, kAnyNumber.in("length"));
    visit.animated("look_at", self.look_at, kAnyNumber.in("length"));
    visit.direction("up", self.up);
    visit.keep_apart("look_from", self.look_from, "look_at", self.look_at);
    if (self.type == "equirectangular") return;
    if (self.type == "orthographic") {
      visit.animated("height", self.height, kPositive.in("length"));
    } else {
      visit.animated("fov", self.fov, Range{0.0, 180.0, true, true}.in("degrees"));
      visit.animated("shift", self.shift, Range{-100.0, 100.0}.in("picture's width, height"));
    }
    visit.map(KeyName{"aperture", ""}, "camera.aperture", self.aperture);
    visit.focus("focus", self.focus_distance, self.focus_object, self.focus_where);
  }
};

}  // namespace hyades::core
