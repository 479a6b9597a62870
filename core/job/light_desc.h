#pragma once

#include <optional>
#include <string>

#include "core/job/animated.h"
#include "core/job/source.h"
#include "core/job/transform_desc.h"

namespace hyades::core {

struct LightDesc {
  std::string name;
  SourceLocation where;
  std::string type;                                   ///< point | spot | projector | sun
  Animated<Vec3> at{Vec3(0.0F)};                      ///< all but sun
  Animated<Vec3> look_at{Vec3(0.0F, -1.0F, 0.0F)};    ///< spot, projector
  Animated<Vec3> up{Vec3(0.0F, 1.0F, 0.0F)};          ///< projector: of its picture
  Animated<Vec3> direction{Vec3(0.0F, -1.0F, 0.0F)};  ///< sun: the way its light travels
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> power{10.0F};      ///< all but sun: W, as if it shone all round
  Animated<float> irradiance{1.0F};  ///< sun: W/m^2 on a surface facing it
  Animated<float> angle{0.53F};      ///< sun: diameter, degrees; spot: half angle of the cone
  Animated<float> blend{0.2F};       ///< spot: share of the cone that fades, 0..1
  Animated<float> fov{40.0F};  ///< projector: across the picture's shorter side, degrees, (0, 180)
  std::string image;           ///< point: lat-long, of how much goes where; projector: the picture
  TransformList transform;     ///< of at, look_at, up, direction and image; after them
  std::string light_group;     ///< empty: none
};

/// A clear sky and its sun.
struct SkyDesc {
  Animated<float> elevation{30.0F};  ///< of the sun above the horizon, degrees
  Animated<float> azimuth{0.0F};     ///< degrees from -z, counter-clockwise seen from above
  std::optional<Animated<Vec3>> sun_direction;  ///< towards the sun, instead of both
  Animated<float> turbidity{3.0F};              ///< 1 is pure air
  Animated<Rgb> ground_albedo{Rgb(0.3F)};
  Animated<float> irradiance{4.0F};  ///< W/m^2 of the sun above the air
  bool sun = true;                   ///< whether its disc shines
  Animated<float> sun_size{0.53F};   ///< its diameter, degrees
};

struct EnvironmentDesc {
  SourceLocation where;
  std::optional<SkyDesc> sky;
  std::string image;               ///< lat-long map; empty = constant colour
  Animated<Rgb> color{Rgb(1.0F)};  ///< constant colour, or a tint of the image
  Animated<float> rotate_y{0.0F};  ///< degrees
  Animated<float> strength{1.0F};
  bool visible_to_camera = true;
  std::string light_group;  ///< empty: none
};

}  // namespace hyades::core
