// Bodies within bodies and bodies that overlap: what a ray along the axis of a stack of slabs sees,
// in closed form, and what must not be seen at all.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

struct Slab {
  double index = 1.0;
  double thickness = 0.0;
  Vec3d absorption{0.0};
};

/// What a stack of layers reflects of light that comes from either side, and lets through, all
/// reflections between them in it (adding method; intensities, for paths know no interference).
struct Stack {
  double front = 0.0;
  double back = 0.0;
  double through = 1.0;

  void add(const Stack& next) {
    const double between = 1.0 / (1.0 - back * next.front);
    front += through * through * next.front * between;
    back = next.back + next.through * next.through * back * between;
    through *= next.through * between;
  }
};

/// Slabs one behind the other as seen from a space of index `from`, air behind them, at normal
/// incidence.
Stack stack_of(double from, const std::vector<Slab>& slabs, int channel) {
  Stack stack;
  const auto face = [&](double to) {
    const double r = std::pow((from - to) / (from + to), 2.0);
    stack.add({r, r, 1.0 - r});
    from = to;
  };
  for (const Slab& slab : slabs) {
    face(slab.index);
    stack.add({0.0, 0.0, std::exp(-slab.thickness * slab.absorption[channel])});
  }
  face(1.0);
  return stack;
}

const Vec3d kInGlass(0.2, 0.5, 0.1);
const Vec3d kInWater(0.1, 0.3, 0.9);

/// A camera that looks along -z at a lamp of radiance 1, 8 m away, through `objects`.
YamlScene along_the_axis(const std::string& objects, const std::string& eye = "4") {
  return YamlScene(R"(
hyades: 1
name: slabs
film: {size: [12, 12], filter: box}
sampling: {samples: 4096, seed: 5, sampler: independent}
integrator: {type: path, max_depth: 200}
camera: {look_from: [0, 0, )" +
                   eye + R"(], look_at: [0, 0, -4], fov: 0.01}
media:
  in-glass: {absorption: [0.2, 0.5, 0.1]}
  in-water: {absorption: [0.1, 0.3, 0.9]}
materials:
  black: {type: black}
  glass: {type: dielectric, ior: 1.7}
  water: {type: dielectric, ior: 1.3}
  bubble: {type: dielectric, ior: 1}
objects:
  lamp: {shape: rectangle, size: [9, 9], material: black, at: [0, 0, -4], transform: [{rotate_x: 90}], emit: {radiance: 1}}
)" + objects);
}

const char* const kGlass =
    "  glass: {shape: box, size: [3, 3, 1], material: glass, interior: in-glass";
const char* const kWater =
    "  water: {shape: box, size: [2, 2, 1.75], at: [0, 0, -1.125], material: water, interior: "
    "in-water";

constexpr Promise kNestedPromise{
    .significance = 0.01, .tests = 24, .relative_error = 0.01, .power = 0.99};

Vec3d through(const std::vector<Slab>& slabs) {
  Vec3d share;
  for (int channel = 0; channel < 3; ++channel)
    share[channel] = stack_of(1.0, slabs, channel).through;
  return share;
}

// The glass reaches from 0.5 to -0.5, the water from -0.25 to -2.
TEST(NestedBodies, PriorityDecidesWhereTheyOverlap) {
  const Vec3d glass_first = through({{1.7, 1.0, kInGlass}, {1.3, 1.5, kInWater}});
  const Vec3d water_first = through({{1.7, 0.75, kInGlass}, {1.3, 1.75, kInWater}});
  const std::string glass = kGlass;
  const std::string water = kWater;
  expect_picture_mean(along_the_axis(glass + ", priority: 1}\n" + water + "}\n"), glass_first,
                      kNestedPromise);
  expect_picture_mean(along_the_axis(glass + "}\n" + water + ", priority: -2}\n"), glass_first,
                      kNestedPromise);
  expect_picture_mean(along_the_axis(glass + "}\n" + water + ", priority: 1}\n"), water_first,
                      kNestedPromise);
  // Of equal ones the smaller: the water is 2 x 2 x 1.75, the glass 3 x 3 x 1.
  expect_picture_mean(along_the_axis(glass + "}\n" + water + "}\n"), water_first, kNestedPromise);
}

TEST(NestedBodies, RefractAgainstWhatIsAroundThem) {
  const std::string pond =
      "  pond: {shape: box, size: [4, 4, 4], material: water, interior: in-water}\n";
  expect_picture_mean(along_the_axis(pond + kGlass + "}\n"),
                      through({{1.3, 1.5, kInWater}, {1.7, 1.0, kInGlass}, {1.3, 1.5, kInWater}}),
                      kNestedPromise);
  // A bubble of air.
  expect_picture_mean(
      along_the_axis(pond + "  bubble: {shape: box, size: [3, 3, 1], material: bubble}\n"),
      through({{1.3, 1.5, kInWater}, {1.0, 1.0, Vec3d(0.0)}, {1.3, 1.5, kInWater}}),
      kNestedPromise);
}

// Radiance in water is that in air times the square of the index.
TEST(NestedBodies, AreSeenFromWithin) {
  Vec3d seen;
  for (int channel = 0; channel < 3; ++channel) {
    const Stack below =
        stack_of(1.3, {{1.3, 1.0, kInWater}, {1.7, 1.0, kInGlass}, {1.3, 1.5, kInWater}}, channel);
    const Stack above = stack_of(1.3, {{1.3, 0.5, kInWater}}, channel);
    seen[channel] = 1.3 * 1.3 * below.through / (1.0 - below.front * above.front);
  }
  expect_picture_mean(
      along_the_axis(
          "  pond: {shape: box, size: [4, 4, 4], material: water, interior: in-water}\n" +
              std::string(kGlass) + "}\n",
          "1.5"),
      seen, kNestedPromise);
}

// A body wholly within one of higher priority is as if it were not there: to paths, to light paths,
// to their shadow rays, and to a lamp inside.
TEST(NestedBodies, HiddenOnesChangeNothing) {
  const std::string scene = R"(
hyades: 1
name: hidden
film: {size: [24, 18], filter: box}
sampling: {samples: 64, seed: 5}
camera: {look_from: [0, 1.2, 3], look_at: [0, 0.6, 0], fov: 40}
media:
  milk: {scattering: [3, 2, 1], absorption: 0.1, g: 0.4}
  ink: {scattering: 1, absorption: [3, 2, 1]}
materials:
  white: {type: lambert, color: 0.6}
  glass: {type: dielectric, ior: 1.5}
  matched: {type: dielectric, ior: 1}
  diamond: {type: dielectric, ior: 2.4}
objects:
  floor: {shape: rectangle, size: [3, 3], material: white}
  lamp: {shape: sphere, radius: 0.9, at: [0.5, 2.5, 0.8], emit: {radiance: 3}}
  bulb: {shape: sphere, radius: 0.2, at: [0.35, 0.6, 0.1], emit: {radiance: 4}}
  body: {shape: box, size: [1.2, 1, 1], at: [0, 0.51, 0], interior: milk, priority: 3, material: )";
  const std::string hidden =
      "  hidden: {shape: sphere, radius: 0.4, at: [-0.1, 0.5, 0], material: diamond, interior: "
      "ink, "
      "priority: 2}\n";
  const Promise promise{.significance = 0.01, .tests = 6, .relative_error = 0.04, .power = 0.99};
  struct Case {
    std::string surface;
    std::string type;
  };
  // Light comes straight through a matched surface, but not by choosing a lamp: that is left to the
  // bulb.
  for (const Case& c : {Case{"matched", "path"}, Case{"glass", "bdpt"}}) {
    SCOPED_TRACE(c.surface + ", " + c.type);
    const std::string integrator = "integrator: {type: " + c.type + ", max_depth: 12}\n";
    const YamlScene without(scene + c.surface + "}\n" + integrator);
    const YamlScene with(scene + c.surface + "}\n" + hidden + integrator);
    expect_same_picture(render_replicates(without, 16, 6), render_replicates(with, 16, 6), promise);
  }
}

}  // namespace
}  // namespace hyades::test
