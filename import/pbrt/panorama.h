#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/vec.h"
#include "core/image/rgb_channels.h"
#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// What a light has in each direction: a colour, or an equal-area picture of the sphere times it.
struct Layer {
  Rgb color{1.0F};
  std::shared_ptr<const Image> picture;  ///< finite, not negative
  std::array<int, 3> channels{};         ///< of the picture, for red, green and blue
  glm::dmat3 to_light{1.0};              ///< from the job's world

  Rgb at(const Vec3d& direction) const;
  Rgb pixel(int x, int y) const { return rgb_at(*picture, channels, x, y); }
};

/// Sets the picture of `layer` to `file`, as the scene's light `light` names it, of any shape. The
/// error names the light's place.
Status load_picture(const LoadedScene& scene, const Entity& light, const std::string& file,
                    Layer& layer);

/// Sets the picture of `layer` to `file`, one of all directions, which is square. The error names
/// the place of `light`.
Status load_sphere(const LoadedScene& scene, const Entity& light, const std::string& file,
                   Layer& layer);

/// The bytes of an .exr, twice as wide as high: the sum of the layers as EnvironmentMap looks at
/// it.
Result<Bytes> make_panorama(const std::vector<Layer>& layers);

/// Where a direction of unit length lies in an equal-area picture of the sphere, u and v from 0 to
/// 1 (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD").
glm::dvec2 equal_area_square(const Vec3d& direction);

/// The direction of a place in the square: the inverse.
Vec3d equal_area_direction(const glm::dvec2& place);

}  // namespace hyades::core::pbrt
