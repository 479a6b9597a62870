#include "import/pbrt/classic_noise.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace hyades::core::pbrt {
namespace {

constexpr std::array<uint8_t, 256> kTable = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

/// The gradient at a lattice point times the way from there.
double slope(int64_t x, int64_t y, int64_t z, const Vec3d& way) {
  const auto look_up = [](int64_t i) { return int64_t{kTable[static_cast<size_t>(i & 255)]}; };
  const int64_t h = look_up(look_up(look_up(x) + y) + z) & 15;
  // The last four of sixteen repeat some of the twelve edges of a cube.
  const bool last = h == 12 || h == 13;
  const double u = h < 8 || last ? way.x : way.y;
  const double v = h < 4 || last ? way.y : way.z;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

double fade(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

}  // namespace

double classic_noise(const Vec3d& p) {
  const Vec3d cell = glm::floor(p);
  const Vec3d at = p - cell;
  const auto corner = [&](int dx, int dy, int dz) {
    return slope(static_cast<int64_t>(cell.x) + dx, static_cast<int64_t>(cell.y) + dy,
                 static_cast<int64_t>(cell.z) + dz, at - Vec3d(dx, dy, dz));
  };
  const auto row = [&](int dy, int dz) {
    return std::lerp(corner(0, dy, dz), corner(1, dy, dz), fade(at.x));
  };
  const auto square = [&](int dz) { return std::lerp(row(0, dz), row(1, dz), fade(at.y)); };
  return std::lerp(square(0), square(1), fade(at.z));
}

}  // namespace hyades::core::pbrt
