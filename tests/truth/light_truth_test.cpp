// Light on a surface against closed forms, from a job's text to a film: what each kind of light
// gives a Lambert plane, and the radiance in a closed room that glows (T6; closed_rooms_test.cpp
// has more).

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/image/write_image.h"
#include "core/render/render_frame.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/special_functions.h"
#include "tests/support/temp_folder.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

/// What a test of one picture's mean promises: an error of 1 % found with probability 99 %, and at
/// most one of a hundred runs of all the tests of this file failing by chance.
constexpr Promise kLightPromise{
    .significance = 0.01, .tests = 60, .relative_error = 0.01, .power = 0.99};

void expect_picture_mean(const YamlScene& scene, const Vec3d& expected) {
  expect_mean_by_path_and_bdpt(scene, expected, kLightPromise);
}

/// A white-ish Lambert plane y = 0, one point of it looked at from above, and `lights`.
YamlScene plane_under(const std::string& lights, int samples = 2048,
                      const std::string& sampler = "independent",
                      const std::string& look_from = "[0, 0.3, 0]") {
  return YamlScene(R"(
hyades: 1
name: plane
film: {size: [12, 12]}
sampling: {samples: )" +
                   std::to_string(samples) + ", seed: 5, sampler: " + sampler + R"(}
camera: {look_from: )" +
                   look_from +
                   R"(, look_at: [0, 0, 0], up: [0, 0, -1], fov: 0.02}
materials:
  paper: {type: lambert, color: [0.8, 0.5, 0.2]}
  lamp: {type: black}
  air: {type: "null"}
)" + lights);
}

/// The radiance of that plane under `irradiance`.
Vec3d lit(const Vec3d& irradiance) { return Vec3d(0.8, 0.5, 0.2) * irradiance / M_PI; }

const char* const kPlane =
    "objects:\n  plane: {shape: rectangle, size: [0.5, 0.5], material: paper}\n";

std::string with_plane(const std::string& objects) { return kPlane + objects; }

TEST(LightTruth, Point) {
  const YamlScene scene =
      plane_under(std::string(kPlane) +
                  "lights:\n  a: {type: point, at: [1, 2, 0], power: 30, color: [1, 0.5, 2]}\n");
  // Phi cos / (4 pi d^2)
  const double e = 30.0 / (4.0 * M_PI * 5.0) * 2.0 / std::sqrt(5.0);
  expect_picture_mean(scene, lit(e * Vec3d(1.0, 0.5, 2.0)));
}

TEST(LightTruth, SpotInItsMiddleItsBorderAndBesides) {
  const auto spot = [](const std::string& look_at) {
    return plane_under(std::string(kPlane) + "lights:\n  a: {type: spot, at: [0, 2, 0], look_at: " +
                       look_at + ", angle: 40, blend: 0.5, power: 30}\n");
  };
  const double e = 30.0 / (4.0 * M_PI * 4.0);
  expect_picture_mean(spot("[0, 0, 0]"), lit(Vec3d(e)));
  // 30 degrees off the axis: between the inner cone of 20 and the outer of 40.
  const double outer = std::cos(40.0 * M_PI / 180.0);
  const double t =
      (std::cos(30.0 * M_PI / 180.0) - outer) / (std::cos(20.0 * M_PI / 180.0) - outer);
  expect_picture_mean(spot("[" + std::to_string(2.0 * std::tan(M_PI / 6.0)) + ", 0, 0]"),
                      lit(Vec3d(e * t * t * (3.0 - 2.0 * t))));
  expect_picture_mean(spot("[2, 0, 0]"), Vec3d(0.0));
}

TEST(LightTruth, ProjectorAndPointWithAPicture) {
  const TempFolder folder;
  core::Image picture = core::make_image(2, 2, {"R", "G", "B"});
  // Two pixels over two; what is halfway between some is their mean.
  const Vec3d pixels[4] = {{1.0, 0.1, 0.2}, {0.3, 1.0, 0.1}, {0.2, 0.4, 1.0}, {0.7, 0.9, 0.6}};
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) picture.at(i % 2, i / 2, c) = static_cast<float>(pixels[i][c]);
  }
  ASSERT_TRUE(core::write_exr(folder.file("four.exr"), picture).ok());
  const auto under = [&](const std::string& light) {
    return plane_under(std::string(kPlane) + "lights:\n  a: {" + light +
                       ", power: 30, image: " + folder.file("four.exr") + "}\n");
  };
  // Phi cos / (4 pi d^2), the cosine that of 1 across and 2 down.
  const double e = 30.0 / (4.0 * M_PI * 5.0) * 2.0 / std::sqrt(5.0);
  // Straight down from (1, 2, 0) with -z on top: the place that is looked at lies 1 to the left, at
  // half of the way to the border where tan(fov / 2) = 1.
  const std::string projector =
      "type: projector, at: [1, 2, 0], look_at: [1, 0, 0], up: [0, 0, -1], fov: 90";
  expect_picture_mean(under(projector), lit(e * 0.5 * (pixels[0] + pixels[2])));
  // With +x on top that is a place below the middle.
  expect_picture_mean(
      under("type: projector, at: [1, 2, 0], look_at: [1, 0, 0], up: [1, 0, 0], fov: 90"),
      lit(e * 0.5 * (pixels[2] + pixels[3])));
  // Turned by a quarter about y and moved to (0, 2, -1), its right is +z.
  expect_picture_mean(under(projector + ", transform: [{rotate_y: -90}, {translate: [0, 0, -2]}]"),
                      lit(e * 0.5 * (pixels[1] + pixels[3])));
  // Below the middle of the lower row, towards -x, where its ends meet, and towards -z.
  expect_picture_mean(under("type: point, at: [1, 2, 0]"), lit(e * 0.5 * (pixels[2] + pixels[3])));
  expect_picture_mean(under("type: point, at: [0, 2, 1]"), lit(e * pixels[2]));
  // Moved from there by a turn, which its picture follows.
  expect_picture_mean(under("type: point, at: [0, 2, 1], transform: [{rotate_y: 90}]"),
                      lit(e * pixels[2]));
}

TEST(LightTruth, SunAsDirectionAndAsDisc) {
  for (const char* angle : {"0", "0.53", "30"}) {
    const YamlScene scene = plane_under(
        std::string(kPlane) +
        "lights:\n  a: {type: sun, direction: [3, -4, 0], irradiance: 2, angle: " + angle + "}\n");
    expect_picture_mean(scene, lit(Vec3d(2.0 * 0.8)));
  }
}

TEST(LightTruth, SunIsSeenAsADisc) {
  // A camera that sees the whole disc and a little more: the mean over the film is L times the
  // covered share.
  const YamlScene scene(R"(
hyades: 1
name: sun
film: {size: [64, 64], filter: {type: box, radius: 0.5}}
sampling: {samples: 256, sampler: independent}
camera: {look_from: [0, 0, 0], look_at: [0, 1, 0], fov: 12}
lights:
  sun: {type: sun, direction: [0, -1, 0], irradiance: 3, angle: 10}
)");
  const double sine = std::sin(5.0 * M_PI / 180.0);
  const double radiance = 3.0 / (M_PI * sine * sine);
  const double ratio = std::tan(5.0 * M_PI / 180.0) / std::tan(6.0 * M_PI / 180.0);
  expect_picture_mean(scene, Vec3d(radiance * M_PI / 4.0 * ratio * ratio));
}

TEST(LightTruth, ConstantSky) {
  const YamlScene scene =
      plane_under(std::string(kPlane) + "environment: {color: [1, 2, 0.5], strength: 3}\n", 4096);
  expect_picture_mean(scene, lit(M_PI * 3.0 * Vec3d(1.0, 2.0, 0.5)));
}

TEST(LightTruth, PictureOfASky) {
  const YamlScene scene =
      plane_under(std::string(kPlane) +
                      "environment: {image: jobs/quickstart/dusk.exr, rotate_y: 75, strength: 2}\n",
                  5000);
  const core::Light& sky = *scene.renderer().scene().lights[0];
  Vec3d expected(0.0);
  for (int c = 0; c < 3; ++c) {
    expected[c] = integrate2(
        [&](double y, double phi) {
          const double r = std::sqrt(1.0 - y * y);
          const core::Vec3 d(Vec3d(r * std::cos(phi), y, r * std::sin(phi)));
          return y * static_cast<double>(sky.radiance({}, -d)[c]);
        },
        0.0, 1.0, 0.0, 2.0 * M_PI, 1e-2, 32, 2);
  }
  expect_picture_mean(scene, lit(expected));
}

TEST(LightTruth, SphereByRadianceAndByPower) {
  // E = pi L (r / d)^2 cos; with the flux Phi = pi L 4 pi r^2 that is Phi cos / (4 pi d^2).
  const double d2 = 1.0 + 4.0 + 0.25;
  const double cosine = 2.0 / std::sqrt(d2);
  const std::string lamp =
      "  lamp: {shape: sphere, radius: 0.7, at: [1, 2, 0.5], material: lamp, emit: ";
  expect_picture_mean(plane_under(with_plane(lamp + "{radiance: 4, color: [1, 0.5, 2]}}\n")),
                      lit(M_PI * 4.0 * 0.49 / d2 * cosine * Vec3d(1.0, 0.5, 2.0)));
  expect_picture_mean(plane_under(with_plane(lamp + "{power: 50}}\n")),
                      lit(Vec3d(50.0 / (4.0 * M_PI * d2) * cosine)));
}

TEST(LightTruth, SphereTouchingThePlane) {
  // E = pi L (r / d)^2 cos still holds beside it, as the whole ball is above the horizon.
  const double d2 = 0.2 * 0.2 + 0.1 * 0.1;
  const YamlScene scene = plane_under(with_plane("  lamp: {shape: sphere, radius: 0.2, at: [0.1, "
                                                 "0.2, 0], material: lamp, emit: {radiance: 4}}\n"),
                                      2048, "independent", "[-0.5, 0.25, 0]");
  expect_picture_mean(scene, lit(Vec3d(M_PI * 4.0 * 0.04 / d2 * 0.2 / std::sqrt(d2))));
}

TEST(LightTruth, DiskOnItsAxis) {
  const std::string lamp =
      "  lamp: {shape: disk, radius: 0.5, material: lamp, transform: [{rotate_x: 180}], at: [0, "
      "0.6, 0], emit: ";
  expect_picture_mean(plane_under(with_plane(lamp + "{radiance: 4}}\n"), 4096),
                      lit(Vec3d(M_PI * 4.0 * 0.25 / (0.25 + 0.36))));
  // Turned away it is dark, two-sided it is not; by power each side then has half.
  const std::string up =
      "  lamp: {shape: disk, radius: 0.5, material: lamp, at: [0, 0.6, 0], emit: ";
  expect_picture_mean(plane_under(with_plane(up + "{radiance: 4}}\n")), Vec3d(0.0));
  const double radiance = 10.0 / (M_PI * M_PI * 0.25 * 2.0);
  expect_picture_mean(plane_under(with_plane(up + "{power: 10, two_sided: true}}\n"), 4096),
                      lit(Vec3d(M_PI * radiance * 0.25 / (0.25 + 0.36))));
}

double rectangle_irradiance(double x0, double x1, double z0, double z1, double y) {
  return integrate2(
      [&](double x, double z) {
        const double d2 = x * x + y * y + z * z;
        return y * y / (d2 * d2);
      },
      x0, x1, z0, z1);
}

TEST(LightTruth, RectangleByQuadrature) {
  const YamlScene scene = plane_under(with_plane("  lamp: {shape: rectangle, size: [1.2, 0.4], "
                                                 "material: lamp, transform: [{rotate_x: 180}], "
                                                 "at: [0.5, 0.8, -0.3], emit: {radiance: 4}}\n"),
                                      5000);
  expect_picture_mean(scene, lit(Vec3d(4.0 * rectangle_irradiance(-0.1, 1.1, -0.5, -0.1, 0.8))));
}

TEST(LightTruth, BoxByItsVisibleFace) {
  // Straight above, only the lower face is seen.
  const YamlScene scene =
      plane_under(with_plane("  lamp: {shape: box, size: [0.4, 0.2, 0.6], material: lamp, at: [0, "
                             "0.9, 0], emit: {radiance: 4}}\n"),
                  6000);
  expect_picture_mean(scene, lit(Vec3d(4.0 * rectangle_irradiance(-0.2, 0.2, -0.3, 0.3, 0.8))));
}

TEST(LightTruth, CylinderByQuadrature) {
  // A tube along x without caps, in the middle above the point.
  const YamlScene scene = plane_under(
      with_plane("  lamp: {shape: cylinder, radius: 0.1, height: 1, caps: false, material: lamp, "
                 "transform: [{translate: [0, -0.5, 0]}, {rotate_z: 90}], at: [0, 0.5, 0], emit: "
                 "{radiance: 4}}\n"),
      4096);
  const double e = integrate2(
      [](double x, double phi) {
        const Vec3d n(0.0, std::sin(phi), std::cos(phi));
        const Vec3d p = Vec3d(x, 0.5, 0.0) + 0.1 * n;
        const double d2 = glm::dot(p, p);
        return std::max(-glm::dot(n, p), 0.0) * p.y / (d2 * d2) * 0.1;
      },
      -0.5, 0.5, 0.0, 2.0 * M_PI, 1e-6);
  expect_picture_mean(scene, lit(Vec3d(4.0 * e)));
}

TEST(LightTruth, StretchedSphereByQuadrature) {
  const YamlScene scene = plane_under(with_plane("  lamp: {shape: sphere, radius: 1, material: "
                                                 "lamp, transform: [{scale: [0.5, 0.1, 0.2]}], "
                                                 "at: [0.2, 0.6, 0], emit: {radiance: 4}}\n"),
                                      5000);
  const double e = integrate2(
      [](double z, double phi) {
        const double r = std::sqrt(1.0 - z * z);
        const Vec3d unit(r * std::cos(phi), z, r * std::sin(phi));
        const Vec3d p = Vec3d(0.2, 0.6, 0.0) + Vec3d(0.5, 0.1, 0.2) * unit;
        // Area vector of the stretched sphere: the cofactors times the unit sphere's.
        const Vec3d area = Vec3d(0.02, 0.1, 0.05) * unit;
        const double d2 = glm::dot(p, p);
        return std::max(-glm::dot(area, p), 0.0) * p.y / (d2 * d2);
      },
      -1.0, 1.0, 0.0, 2.0 * M_PI, 1e-6);
  expect_picture_mean(scene, lit(Vec3d(4.0 * e)));
}

TEST(LightTruth, MovingLampIsTheMeanOverTheShutter) {
  const YamlScene scene =
      plane_under("frames: {range: 1, fps: 1, shutter: 1}\n" +
                      with_plane("  lamp: {shape: sphere, radius: 0.2, at: [\"= t\", 1, 0], "
                                 "material: lamp, emit: {radiance: 4}}\n"),
                  5000);
  const double e =
      integrate([](double t) { return M_PI * 4.0 * 0.04 / std::pow(1.0 + t * t, 1.5); }, 0.0, 1.0);
  expect_picture_mean(scene, lit(Vec3d(e)));
}

/// All kinds at once: the choice among lights and its part in the weights.
const char* const kManyLights = R"(
  ball: {shape: sphere, radius: 0.7, at: [1, 2, 0.5], material: lamp, emit: {radiance: 4}}
  small: {shape: sphere, radius: 0.02, at: [-1, 2, 0.5], material: lamp, emit: {power: 20}}
  dark: {shape: sphere, radius: 0.02, at: [-1, 2.5, 0.5], material: lamp, emit: {power: 0}}
  away: {shape: disk, radius: 0.1, at: [-0.5, 1, -0.5], material: lamp, emit: {radiance: 9}}
lights:
  point: {type: point, at: [0, 3, 1], power: 40}
  sun: {type: sun, direction: [0, -1, -1], irradiance: 0.4, angle: 1}
  noon: {type: sun, direction: [1, -1, 1], irradiance: 0.3, angle: 0}
)";

double mean_of_many_lights() {
  const double d2 = 1.0 + 4.0 + 0.25;
  const double ball = M_PI * 4.0 * 0.49 / d2 * 2.0 / std::sqrt(d2);
  const double small = 20.0 / (4.0 * M_PI * d2) * 2.0 / std::sqrt(d2);
  const double point = 40.0 / (4.0 * M_PI * 10.0) * 3.0 / std::sqrt(10.0);
  return ball + small + point + 0.4 * M_SQRT1_2 + 0.3 / std::sqrt(3.0);
}

TEST(LightTruth, ManyLightsAddUp) {
  for (const char* sampler : {"independent", "sobol"}) {
    expect_picture_mean(plane_under(with_plane(kManyLights), 4096, sampler),
                        lit(Vec3d(mean_of_many_lights())));
  }
}

TEST(LightTruth, BoundariesThatAreNotThereLetLightThrough) {
  // A shell of null material around the looked-at point: light that was chosen and light that was
  // found must both pass, or their weights no longer add up to one.
  const std::string shell =
      "  shell: {shape: sphere, radius: 0.1, material: air}\n"
      "  pane: {shape: rectangle, size: [9, 9], at: [0, 0.2, 0], material: air}\n";
  expect_picture_mean(plane_under(with_plane(shell + std::string(kManyLights).substr(1)), 4096),
                      lit(Vec3d(mean_of_many_lights())));
}

TEST(LightTruth, ClosedGlowingSphere) {
  // T6: everything emits E and reflects albedo rho, so that everywhere L = E + rho L.
  for (const char* sampler : {"independent", "sobol"}) {
    for (const char* from : {"[0.3, -0.5, 0.6]", "[0, 0.97, 0]"}) {
      const YamlScene scene(std::string(R"(
hyades: 1
name: furnace
film: {size: [16, 16]}
sampling: {samples: 720, seed: 3, sampler: )") +
                            sampler + R"(}
integrator: {type: path, max_depth: 1000}
camera: {look_from: )" + from +
                            R"(, look_at: [0.5, -0.2, 0.1], fov: 90}
materials:
  wall: {type: lambert, color: [0.8, 0.5, 0.2]}
objects:
  room: {shape: sphere, radius: 1, material: wall, emit: {radiance: 2, color: [1, 2, 3], two_sided: true}}
)");
      // By all integrators in closed_rooms_test.cpp, with fewer events.
      test::expect_picture_mean(scene, Vec3d(2.0 / 0.2, 4.0 / 0.5, 6.0 / 0.8), kLightPromise);
    }
  }
}

TEST(LightTruth, NothingToChooseFromIsNoTrouble) {
  expect_picture_mean(plane_under(kPlane), Vec3d(0.0));
  expect_picture_mean(plane_under(std::string(kPlane) + "environment: {color: 0}\n"), Vec3d(0.0));
  expect_picture_mean(
      plane_under(
          with_plane("  lamp: {shape: sphere, radius: 0.1, at: [0, 1, 0], emit: {power: 0}}\n")),
      Vec3d(0.0));
}

}  // namespace
}  // namespace hyades::test
