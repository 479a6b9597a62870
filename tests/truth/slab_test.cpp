// What slabs of scattering media send back and let through of light that falls straight onto them.
// The numbers are those of an independent, deterministic method, adding and doubling (van de Hulst,
// "Multiple Light Scattering", 1980, chapter 4; Prahl, van Gemert and Welch, "Determining the
// optical properties of turbid media by using the adding-doubling method", Applied Optics 32,
// 1993), as Prahl's program iadpython (revision dc8c91c) gives them with 24 quadrature points and,
// behind glass, 40; with fewer points the last digit hardly changes. Among them are published ones:
// optical thickness 2, albedo 0.9, g 0.75 reflects 0.09739 and transmits 0.66096 (van de Hulst
// 1980, table 35); a half-space of albedo 0.9 behind index 1.5 reflects 0.2600 (Giovanelli,
// "Reflection by semi-infinite diffusers", Optica Acta 2, 1955).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

/// Three slabs at once, one in each channel.
struct Slabs {
  const char* name;
  const char* surface;
  const char* medium;  ///< optical thickness is the density: slabs are 1 m thick
  std::array<double, 3> reflected;
  std::array<double, 3> transmitted;
  const char* integrator = "path, max_depth: 10000, roulette_depth: 32";
};

void PrintTo(const Slabs& slabs, std::ostream* out) { *out << slabs.name; }

constexpr const char* kNull = "{type: \"null\"}";

const Slabs kSlabs[] = {
    {"forward",
     kNull,
     "albedo: [0.9, 0.5, 0.99], density: [2, 1, 8], g: 0.75",
     {0.09739, 0.01511, 0.43305},
     {0.66096, 0.56461, 0.41634}},
    {"isotropic",
     kNull,
     "albedo: [0.9, 0.5, 0.99], density: [1, 2, 4]",
     {0.26741, 0.11283, 0.64505},
     {0.59163, 0.18932, 0.27548}},
    {"backward",
     kNull,
     "albedo: [0.9, 0.5, 0.99], density: [2, 1, 8], g: -0.4",
     {0.44587, 0.15213, 0.77448},
     {0.28705, 0.41020, 0.08340}},
    {"without_absorption",
     kNull,
     "albedo: [0.9, 0.7, 1], density: [4, 1, 8], g: 0.5",
     {0.26118, 0.07156, 0.68897},
     {0.25053, 0.61226, 0.31103}},
    {"forward_behind_glass",
     "{type: dielectric, ior: 1.4}",
     "albedo: [0.9, 0.5, 0.99], density: [2, 1, 8], g: 0.75",
     {0.11621, 0.04290, 0.37720},
     {0.52703, 0.50223, 0.37216}},
    {"endless_behind_glass",
     "{type: dielectric, ior: 1.5}",
     "albedo: [0.9, 0.5, 0.95], density: 200",
     {0.25993, 0.08425, 0.36113},
     {0.0, 0.0, 0.0}},
    {"milk",
     "{type: dielectric, ior: 1.33}",
     "albedo: [0.9, 0.95, 0.99], density: [200, 5, 5], g: 0.5",
     {0.18923, 0.28472, 0.45985},
     {0.0, 0.21916, 0.38247}},
    {"forward_by_bdpt",
     kNull,
     "albedo: [0.9, 0.5, 0.5], density: [2, 1, 1], g: 0.75",
     {0.09739, 0.01511, 0.01511},
     {0.66096, 0.56461, 0.56461},
     "bdpt, max_depth: 48"},
};

class SlabTruth : public testing::TestWithParam<Slabs> {};

/// Light that falls straight onto a slab and leaves it anywhere is, the other way round, what a
/// camera that looks straight at it sees of an even sky. `dark`: the height of a black plane that
/// hides half of it.
PictureMean seen(const Slabs& slabs, double dark) {
  const YamlScene scene(std::string(R"(
hyades: 1
name: slab
film: {size: [16, 16], filter: box}
sampling: {samples: 560, seed: 5, sampler: independent}
camera: {look_from: [0, 0.5, 0], look_at: [0, 0, 0], up: [0, 0, 1], fov: 0.0001}
materials: {skin: )") + slabs.surface +
                        R"(, nothing: {type: black}}
media: {body: {)" + slabs.medium +
                        R"(}}
integrator: {type: )" + slabs.integrator +
                        R"(}
objects:
  slab: {shape: box, size: [4000, 1, 4000], at: [0, -0.5, 0], material: skin, interior: body}
  plane: {shape: rectangle, size: [40000, 40000], at: [0, )" +
                        std::to_string(dark) + R"(, 0], material: nothing}
environment: {color: 1}
)");
  return picture_mean(scene.render().film);
}

/// Notices an error of 0.018, and of a quarter of small shares, with 99 %.
void expect_share(const PictureMean& found, const std::array<double, 3>& expected) {
  const double alpha = sidak(0.01, 6 * static_cast<int>(std::size(kSlabs)));
  for (int c = 0; c < 3; ++c) {
    const double right = expected[static_cast<size_t>(c)];
    const double variance = found.sigma[c] * found.sigma[c];
    const double noticed = right > 0.0 ? std::min(0.018, 0.25 * right) : 0.018;
    EXPECT_LE(detectable_effect(variance, alpha, 0.99), noticed) << "underpowered";
    // The table's last digit.
    EXPECT_GE(z_test(found.mean[c] - right, variance + 1e-10), alpha)
        << "channel " << c << ": " << found.mean[c] << " +- " << found.sigma[c] << ", not "
        << right;
  }
}

TEST_P(SlabTruth, ReflectsAndTransmitsAsTabulated) {
  const Slabs& slabs = GetParam();
  {
    SCOPED_TRACE("reflected");
    expect_share(seen(slabs, -2.0), slabs.reflected);
  }
  {
    SCOPED_TRACE("transmitted");
    expect_share(seen(slabs, 1.0), slabs.transmitted);
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, SlabTruth, testing::ValuesIn(kSlabs),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace hyades::test
