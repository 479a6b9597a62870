#pragma once

#include <optional>
#include <string>
#include <variant>

#include "core/job/animated.h"
#include "core/job/fields.h"
#include "core/job/kinds_of.h"
#include "core/job/source.h"
#include "core/job/transform_desc.h"
#include "core/job/visibility_desc.h"

/// Lights: one struct per type, each with its keys. What makes a light of them stands in
/// core/scene/light_makers.cpp.
namespace hyades::core {

struct LightTraits {
  const char* type = "";  ///< its name in jobs
};

struct PointLightDesc {
  static constexpr LightTraits kTraits{"point"};
  Animated<Vec3> at{Vec3(0.0F)};
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> power{10.0F};
  Animated<float> radius{0.0F};  ///< of the ball that shines; 0: a single place
  std::string image;             ///< lat-long, of how much goes where; empty: the same everywhere

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated("at", self.at, kAnyNumber.in("length"));
    visit.color("color", self.color, kNotNegative);
    visit.animated("power", self.power, kNotNegative.in("W"));
    visit.animated("radius", self.radius, kNotNegative.in("length"));
    visit.file("image", self.image);
  }
};

struct SpotLightDesc {
  static constexpr LightTraits kTraits{"spot"};
  Animated<Vec3> at{Vec3(0.0F)};
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> power{10.0F};  ///< as if it shone all round
  Animated<float> radius{0.0F};  ///< of the ball that shines; 0: a single place
  Animated<Vec3> look_at{Vec3(0.0F, -1.0F, 0.0F)};
  Animated<float> angle{30.0F};  ///< half that of the cone
  Animated<float> blend{0.2F};   ///< share of the cone that fades

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated("at", self.at, kAnyNumber.in("length"));
    visit.color("color", self.color, kNotNegative);
    visit.animated("power", self.power, kNotNegative.in("W"));
    visit.animated("radius", self.radius, kNotNegative.in("length"));
    visit.animated("look_at", self.look_at, kAnyNumber.in("length"));
    visit.keep_apart("at", self.at, "look_at", self.look_at);
    visit.animated("angle", self.angle, Range{0.0, 180.0, true}.in("degrees"));
    visit.animated("blend", self.blend, kUnitInterval);
  }
};

struct ProjectorLightDesc {
  static constexpr LightTraits kTraits{"projector"};
  Animated<Vec3> at{Vec3(0.0F)};
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> power{10.0F};  ///< as if it shone all round
  Animated<float> radius{0.0F};  ///< of the ball that shines; 0: a single place
  Animated<Vec3> look_at{Vec3(0.0F, -1.0F, 0.0F)};
  Animated<Vec3> up{Vec3(0.0F, 1.0F, 0.0F)};  ///< of its picture
  Animated<float> fov{40.0F};                 ///< across the picture's shorter side
  std::string image;                          ///< the picture

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated("at", self.at, kAnyNumber.in("length"));
    visit.color("color", self.color, kNotNegative);
    visit.animated("power", self.power, kNotNegative.in("W"));
    visit.animated("radius", self.radius, kNotNegative.in("length"));
    visit.animated("look_at", self.look_at, kAnyNumber.in("length"));
    visit.keep_apart("at", self.at, "look_at", self.look_at);
    visit.direction("up", self.up);
    visit.animated("fov", self.fov, Range{0.0, 180.0, true, true}.in("degrees"));
    visit.require("image", "the picture that it throws");
    visit.file("image", self.image);
  }
};

struct SunLightDesc {
  static constexpr LightTraits kTraits{"sun"};
  Animated<Vec3> direction{Vec3(0.0F, -1.0F, 0.0F)};  ///< the way its light travels
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> irradiance{1.0F};  ///< on a surface facing it
  Animated<float> angle{0.53F};      ///< its diameter

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.direction("direction", self.direction);
    visit.color("color", self.color, kNotNegative);
    visit.animated("irradiance", self.irradiance, kNotNegative.in("W/m²"));
    visit.animated("angle", self.angle, Range{0.0, 90.0}.in("degrees"));
  }
};

using LightKind = std::variant<PointLightDesc, SpotLightDesc, ProjectorLightDesc, SunLightDesc>;

struct LightDesc {
  std::string name;
  SourceLocation where;
  LightKind kind;
  TransformList transform;  ///< of all places and directions of it, and of its picture; after them
  std::string light_group;  ///< empty: none
  VisibilityDesc visible;   ///< to scattered rays
  LightLinkDesc links;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.enter_section("lights");
    visit.transform("transform", self.transform);
    VisibilityDesc::scattered_fields(self.visible, visit);
    LightLinkDesc::fields(self.links, visit);
    visit.enter_section("lights." + KindsOf<LightKind>::name(self.kind));
    std::visit([&](auto& kind) { kind.fields(kind, visit); }, self.kind);
    visit.light_group("light_group", self.light_group);
  }
};

/// A clear sky and its sun.
struct SkyDesc {
  Animated<float> elevation{30.0F};             ///< of the sun above the horizon
  Animated<float> azimuth{0.0F};                ///< from -z, counter-clockwise seen from above
  std::optional<Animated<Vec3>> sun_direction;  ///< towards the sun, instead of both
  Animated<float> turbidity{3.0F};              ///< 1 is pure air
  Animated<Rgb> ground_albedo{Rgb(0.3F)};
  Animated<float> irradiance{4.0F};  ///< of the sun above the air
  bool sun = true;                   ///< whether its disc shines
  Animated<float> sun_size{0.53F};   ///< its diameter

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated("elevation", self.elevation, Range{-90.0, 90.0}.in("degrees"));
    visit.animated("azimuth", self.azimuth, kAnyNumber.in("degrees"));
    visit.direction("sun_direction", self.sun_direction);
    visit.animated("turbidity", self.turbidity, {1.0, 10.0});
    visit.color("ground_albedo", self.ground_albedo, kUnitInterval);
    visit.animated("irradiance", self.irradiance, kNotNegative.in("W/m²"));
    visit.flag("sun", self.sun);
    visit.animated("sun_size", self.sun_size, Range{0.0, 90.0}.in("degrees"));
  }
};

struct EnvironmentDesc {
  SourceLocation where;
  std::string image;  ///< lat-long map; empty = constant colour
  std::optional<SkyDesc> sky;
  Animated<Rgb> color{Rgb(1.0F)};  ///< constant colour, or a tint of the image
  Animated<float> rotate_y{0.0F};
  Animated<float> strength{1.0F};
  VisibilityDesc visible;   ///< but to shadow rays
  std::string light_group;  ///< empty: none
  LightLinkDesc links;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.file("image", self.image);
    visit.map("sky", "environment.sky", self.sky);
    visit.color("color", self.color, kNotNegative.in("W/(m² sr)"));
    visit.animated("rotate_y", self.rotate_y, kAnyNumber.in("degrees"));
    visit.animated("strength", self.strength, kNotNegative);
    visit.flag("visible_to_camera", self.visible.camera);
    VisibilityDesc::scattered_fields(self.visible, visit);
    visit.light_group("light_group", self.light_group);
    LightLinkDesc::fields(self.links, visit);
  }
};

}  // namespace hyades::core
