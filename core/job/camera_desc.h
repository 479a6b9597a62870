#pragma once

#include <optional>
#include <string>

#include "core/job/animated.h"
#include "core/job/source.h"

namespace hyades::core {

struct CameraDesc {
  std::string type = "perspective";  ///< or "orthographic", "equirectangular"
  Animated<Vec3> look_from{Vec3(0.0F, 1.0F, 5.0F)};
  Animated<Vec3> look_at{Vec3(0.0F)};
  Animated<Vec3> up{Vec3(0.0F, 1.0F, 0.0F)};
  Animated<float> fov{40.0F};             ///< perspective: vertical, degrees, (0, 180)
  Animated<Vec2> shift{Vec2(0.0F)};       ///< perspective: to the right, up; of width and height
  Animated<float> height{5.0F};           ///< orthographic: of what the picture shows, length
  Animated<float> aperture_radius{0.0F};  ///< length; 0 = pinhole (no panoramas)
  std::optional<Animated<float>>
      f_stop;               ///< radius = focal length / (2 f_stop), on a 24 mm high sensor
  int aperture_blades = 0;  ///< 0 = round, else >= 3
  Animated<float> aperture_rotation{0.0F};        ///< degrees
  std::optional<Animated<float>> focus_distance;  ///< along the view axis; absent: to look_at
  std::string focus_object;                       ///< focus on this object's centre
  SourceLocation focus_where;                     ///< of its name
};

}  // namespace hyades::core
