#include "import/pbrt/color_space.h"

#include <algorithm>
#include <array>

#include "core/base/text.h"

namespace hyades::core::pbrt {
namespace {

struct Chromaticity {
  double x, y;
};

glm::dmat3 matrix_of(Chromaticity r, Chromaticity g, Chromaticity b, Chromaticity w) {
  const glm::dmat3 primaries(xyz_of_chromaticity(r.x, r.y), xyz_of_chromaticity(g.x, g.y),
                             xyz_of_chromaticity(b.x, b.y));
  const Vec3d scale = glm::inverse(primaries) * xyz_of_chromaticity(w.x, w.y);
  return {primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z};
}

constexpr Chromaticity kD65{0.3127, 0.3290};
constexpr Chromaticity kD60{0.32168, 0.33767};

/// ITU-R BT.709-6; SMPTE RP 431-2 with D65 (its green as pbrt-v4 has it); ITU-R BT.2020-2; SMPTE
/// ST 2065-1.
const std::array<RgbSpace, 4>& spaces() {
  static const std::array<RgbSpace, 4> all{{
      {"srgb", matrix_of({0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, kD65)},
      {"dci-p3", matrix_of({0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65)},
      {"rec2020", matrix_of({0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, kD65)},
      {"aces2065-1", matrix_of({0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, kD60)},
  }};
  return all;
}

/// Lam 1985, the "Bradford" transform: XYZ -> cone-like responses.
glm::dmat3 bradford() {
  return glm::transpose(
      glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
}

}  // namespace

Rgb without_negatives(const Vec3d& color) { return {glm::max(color, Vec3d(0.0))}; }

Vec3d xyz_of_chromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

const RgbSpace* srgb_space() { return spaces().data(); }

const RgbSpace* find_rgb_space(std::string_view name) {
  const auto found = std::ranges::find(spaces(), lower_case(name), &RgbSpace::name);
  return found == spaces().end() ? nullptr : &*found;
}

Vec3d rec709_from_xyz(const Vec3d& xyz) {
  static const glm::dmat3 inverse = glm::inverse(srgb_space()->to_xyz);
  return inverse * xyz;
}

Rgb light_from_rgb(const RgbSpace& space, const Vec3d& rgb) {
  if (&space == srgb_space()) return without_negatives(rgb);
  return without_negatives(rec709_from_xyz(space.to_xyz * rgb));
}

Rgb surface_from_rgb(const RgbSpace& space, const Vec3d& rgb) {
  if (&space == srgb_space()) return without_negatives(rgb);
  const Vec3d from = bradford() * (space.to_xyz * Vec3d(1.0));
  const Vec3d to = bradford() * (srgb_space()->to_xyz * Vec3d(1.0));
  const Vec3d adapted = (bradford() * (space.to_xyz * rgb)) * (to / from);
  return without_negatives(rec709_from_xyz(glm::inverse(bradford()) * adapted));
}

}  // namespace hyades::core::pbrt
