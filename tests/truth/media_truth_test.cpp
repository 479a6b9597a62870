// Light in media against closed forms and quadrature, from a job's text to a film (T5, T7 and T8).

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/quadrature.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

/// An error of 1 % is found with probability 99 %, and at most one of a hundred runs of all the
/// tests of this file fails by chance.
constexpr Promise kMediaPromise{
    .significance = 0.01, .tests = 87, .relative_error = 0.01, .power = 0.99};

/// A camera with next to no field of view that looks from (0, 0, 4) along -z, so that every pixel
/// sees the same.
std::string ray_job(int samples, int max_depth, const std::string& rest,
                    const std::string& camera = "look_from: [0, 0, 4], look_at: [0, 0, 0]") {
  return R"(
hyades: 1
name: ray
film: {size: [12, 12], filter: box}
sampling: {samples: )" +
         std::to_string(samples) + R"(, seed: 3, sampler: independent}
integrator: {type: path, max_depth: )" +
         std::to_string(max_depth) + R"(}
camera: {)" +
         camera + R"(, fov: 0.01}
materials:
  air: {type: "null"}
  lamp: {type: black}
  paper: {type: lambert, color: 0.6}
  clear: {type: dielectric, ior: 1}
)" + rest;
}

// T7: what a slab absorbs, and what it gives off, per channel.
TEST(MediaTruth, SlabsAbsorbAndGlow) {
  const YamlScene absorbing(ray_job(16, 8, R"(
media: {dye: {absorption: [0.1, 0.7, 2]}}
objects: {slab: {shape: box, size: [3, 3, 1.5], material: air, interior: dye}}
environment: {color: [1, 2, 3]}
)"));
  expect_mean_by_path_and_bdpt(
      absorbing, {std::exp(-0.15), 2.0 * std::exp(-1.05), 3.0 * std::exp(-3.0)}, kMediaPromise);
  const YamlScene glowing(ray_job(16, 8, R"(
units: cm
media: {neon: {absorption: [0.1, 0.7, 2], emission: [2, 1, 3]}}
objects: {slab: {shape: box, size: [3, 3, 1.5], material: air, interior: neon}}
)"));
  const auto glow = [](double sigma) { return -std::expm1(-1.5 * sigma) / sigma; };
  expect_mean_by_path_and_bdpt(glowing, {2.0 * glow(0.1), glow(0.7), 3.0 * glow(2.0)},
                               kMediaPromise);
}

// A lamp's light on paper, through two metres of coloured fog that only absorbs: the same with the
// whole world in fog and with a body of it around the way, lamp or paper inside or outside.
TEST(MediaTruth, ShadowRaysAreAttenuated) {
  const auto paper = [](const std::string& rest) {
    return YamlScene(ray_job(1024, 4, rest + R"(
  paper: {shape: rectangle, size: [1, 1], material: paper}
lights: {lamp: {type: point, at: [0, 3, 0], power: 50}}
)",
                             "look_from: [0, 0.001, 0], look_at: [0, 0, 0], up: [0, 0, 1]"));
  };
  const double radiance = 0.6 / M_PI * 50.0 / (4.0 * M_PI * 9.0);
  const auto through = [&](double length) {
    return radiance * Vec3d(std::exp(-0.1 * length), std::exp(-0.4 * length), 1.0);
  };
  expect_mean_by_path_and_bdpt(
      paper("media: {fog: {absorption: [0.1, 0.4, 0]}}\natmosphere: fog\nobjects:"), through(3.001),
      kMediaPromise);
  const std::string fog = "media: {fog: {absorption: [0.1, 0.4, 0]}}\nobjects:\n";
  const std::string slab = "  slab: {shape: box, material: air, interior: fog, size: ";
  expect_mean_by_path_and_bdpt(paper(fog + slab + "[4, 2, 4], at: [0, 1.5, 0]}"), through(2.0),
                               kMediaPromise);
  expect_mean_by_path_and_bdpt(paper(fog + slab + "[4, 2, 4], at: [0, 3, 0]}"), through(1.0),
                               kMediaPromise);
  expect_mean_by_path_and_bdpt(paper(fog + slab + "[4, 2, 4], at: [0, 0, 0]}"), through(1.001),
                               kMediaPromise);
  expect_mean_by_path_and_bdpt(paper(fog + slab + "[4, 20, 4], at: [0, 0, 0]}"), through(3.001),
                               kMediaPromise);
}

// T8: light of a point lamp scattered once on its way into the eye, against quadrature along the
// ray, for phase functions of several kinds.
TEST(MediaTruth, SingleScatteringFromAPointLamp) {
  struct Case {
    const char* phase;
    double g;
    double other_g;
    double blend;
    bool rayleigh;
  };
  const Case cases[] = {{"g: 0", 0, 0, 0, false},
                        {"g: 0.6", 0.6, 0, 0, false},
                        {"g: -0.4", -0.4, 0, 0, false},
                        {"g: 0.7, g2: -0.3, blend: 0.4", 0.7, -0.3, 0.4, false},
                        {"phase: rayleigh", 0, 0, 0, true}};
  const auto hg = [](double cosine, double g) {
    return (1.0 - g * g) / (4.0 * M_PI * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
  };
  const double absorption[3] = {0.05, 0.1, 0.0};
  const double scattering[3] = {0.2, 0.6, 0.1};
  for (const Case& c : cases) {
    // The wall behind ends the ray 8 m from the eye; it is black.
    const YamlScene scene(ray_job(12000, 1,
                                  std::string(R"(
media: {fog: {absorption: [0.05, 0.1, 0], scattering: [0.2, 0.6, 0.1], )") +
                                      c.phase + R"(}}
atmosphere: fog
objects: {wall: {shape: rectangle, size: [9, 9], material: lamp, at: [0, 0, -4], transform: [{rotate_x: 90}]}}
lights: {lamp: {type: point, at: [0, 1.2, 0.5], power: 100}}
)"));
    Vec3d expected(0.0);
    for (int channel = 0; channel < 3; ++channel) {
      const double extinction = absorption[channel] + scattering[channel];
      expected[channel] = integrate(
          [&](double s) {
            const double z = 3.5 - s;  // along the ray, from the foot of the lamp's perpendicular
            const double d2 = 1.44 + z * z;
            const double d = std::sqrt(d2);
            // Light travels from the lamp down to the ray and on towards +z.
            const double cosine = z / d;
            const double p =
                c.rayleigh ? 3.0 / (16.0 * M_PI) * (1.0 + cosine * cosine)
                           : (1.0 - c.blend) * hg(cosine, c.g) + c.blend * hg(cosine, c.other_g);
            return scattering[channel] * p * 100.0 / (4.0 * M_PI * d2) *
                   std::exp(-extinction * (s + d));
          },
          0.0, 8.0, 1e-9, 64);
    }
    SCOPED_TRACE(c.phase);
    if (c.rayleigh || c.blend > 0.0) {
      expect_mean_by_path_and_bdpt(scene, expected, kMediaPromise);
    } else {
      expect_picture_mean(scene, expected, kMediaPromise);
    }
  }
}

// T5: a body that only scatters cannot be seen under a uniform sky, whatever its surface.
TEST(MediaTruth, WhiteMediaVanishUnderAUniformSky) {
  for (const char* surface :
       {"{type: \"null\"}", "{type: dielectric, ior: 1.33}", "{type: dielectric, ior: 1}"}) {
    const YamlScene scene(std::string(R"(
hyades: 1
name: vanish
film: {size: [16, 16], filter: box}
sampling: {samples: 1536, seed: 2, sampler: independent}
integrator: {type: path, max_depth: 20000}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 30}
materials: {skin: )") + surface +
                          R"(}
media: {white: {scattering: [1, 4, 2], g: 0.5}}
objects:
  ball: {shape: sphere, radius: 0.8, at: [-0.3, 0, 0], material: skin, interior: white}
  can: {shape: cylinder, radius: 0.3, height: 0.8, at: [0.8, -0.4, 0.5], material: skin, interior: white}
environment: {color: [1, 2, 0.5]}
)");
    SCOPED_TRACE(surface);
    expect_picture_mean(scene, {1.0, 2.0, 0.5}, kMediaPromise);
  }
}

// Walks of hundreds of events by bidirectional paths, which join only some of their vertices: light
// stays in a body of high index for long.
TEST(MediaTruth, LongWalksOfBdptLoseNothing) {
  const YamlScene scene(R"(
hyades: 1
name: vanish
film: {size: [8, 8], filter: box}
sampling: {samples: 64, seed: 2}
integrator: {type: bdpt, max_depth: 5000}
camera: {look_from: [0, 0, 4], look_at: [0, 0, 0], fov: 12}
materials: {skin: {type: dielectric, ior: 2}}
media: {white: {scattering: [12, 13, 14]}}
objects:
  ball: {shape: sphere, radius: 1, material: skin, interior: white}
environment: {color: 1}
)");
  const Replicates found = render_replicates(scene, 48, 8);
  EXPECT_EQ(found.bad_samples, 0U);
  Promise promise = kMediaPromise;
  promise.relative_error = 0.045;
  for (const Moments& channel : found.picture) EXPECT_TRUE(mean_is(channel, 1.0, promise));
}

/// Chandrasekhar's H for isotropic scattering of albedo `w`, by iterating his equation
/// 1 / H(x) = sqrt(1 - w) + w / 2 integral_0^1 y H(y) / (x + y) dy (Radiative Transfer, 1960,
/// section 38) on Gauss-Legendre points.
class HFunction {
 public:
  explicit HFunction(double w) : w_(w), h_(kPoints, 1.0) {
    for (int round = 0; round < 150; ++round) {
      std::vector<double> next(kPoints);
      for (int i = 0; i < kPoints; ++i) next[static_cast<size_t>(i)] = at(point(i));
      h_ = next;
    }
  }
  /// Integral over [0, 1]: (2 / w) (1 - sqrt(1 - w)) exactly (section 38, equation 24).
  double integral() const { return std::accumulate(h_.begin(), h_.end(), 0.0) / kPoints; }

  double at(double x) const {
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double y = point(i);
      sum += y * h_[static_cast<size_t>(i)] / (x + y) / kPoints;
    }
    return 1.0 / (std::sqrt(1.0 - w_) + 0.5 * w_ * sum);
  }

 private:
  static constexpr int kPoints = 400;
  static double point(int i) { return (i + 0.5) / kPoints; }
  double w_;
  std::vector<double> h_;
};

// What an endless depth of fog sends back to the eye of sunlight: Chandrasekhar's law of diffuse
// reflection, I = E w / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0) with E per area across the beam. The
// albedo differs by channel, the extinction too.
TEST(MediaTruth, HalfSpaceReflectsByTheHFunction) {
  const double mu0 = 0.8;
  const double mu = 0.6;
  const YamlScene scene(ray_job(6000, 5000, R"(
media: {fog: {albedo: [0.9, 0.5, 0.99], density: [200, 100, 300]}}
objects: {sea: {shape: box, size: [40, 10, 40], at: [0, -5, 0], material: air, interior: fog}}
lights: {sun: {type: sun, direction: [0.6, -0.8, 0], angle: 0, irradiance: 2}}
)",
                                "look_from: [0, 0.6, 0.8], look_at: [0, 0, 0]"));
  Vec3d expected(0.0);
  const double albedo[3] = {0.9, 0.5, 0.99};
  for (int c = 0; c < 3; ++c) {
    const HFunction h(albedo[c]);
    ASSERT_NEAR(h.integral(), 2.0 / albedo[c] * (1.0 - std::sqrt(1.0 - albedo[c])), 1e-3);
    expected[c] = 2.0 * albedo[c] / (4.0 * M_PI) * mu0 / (mu + mu0) * h.at(mu) * h.at(mu0);
  }
  expect_picture_mean(scene, expected, kMediaPromise);
}

// Light is found by choosing a lamp and by chance; together they must count once, through media and
// their boundaries too: a ball's light in fog by area lights of several sizes equals that of a
// point lamp of the same power far enough away.
TEST(MediaTruth, AreaLightsInFogShineLikePoints) {
  const auto lit = [](const std::string& lamp) {
    return picture_mean(YamlScene(ray_job(20000, 3, R"(
media: {fog: {scattering: [0.1, 0.2, 0.05], g: 0.4}}
atmosphere: fog
)" + lamp))
                            .render()
                            .film);
  };
  const PictureMean point = lit("lights: {lamp: {type: point, at: [0, 3, 0], power: 100}}");
  const PictureMean ball =
      lit("objects: {lamp: {shape: sphere, radius: 0.1, at: [0, 3, 0], material: lamp, emit: "
          "{power: 100}}}");
  const double alpha = sidak(kMediaPromise.significance, kMediaPromise.tests);
  for (int c = 0; c < 3; ++c) {
    const double variance = point.sigma[c] * point.sigma[c] + ball.sigma[c] * ball.sigma[c];
    EXPECT_LE(detectable_effect(variance, alpha, 0.99), 0.06 * point.mean[c]);
    EXPECT_GE(z_test(point.mean[c] - ball.mean[c], variance), alpha)
        << point.mean[c] << " and " << ball.mean[c];
  }
}

// The eye within a body of fog, and a clear ball of glass in fog, which keeps it out.
TEST(MediaTruth, TheCameraMayStandInAMedium) {
  const YamlScene inside(ray_job(16, 8, R"(
media: {dye: {absorption: [0.1, 0.7, 2]}}
objects:
  hall: {shape: box, size: [20, 20, 20], material: air, interior: dye}
  hole: {shape: sphere, radius: 1, material: air}
environment: {color: 1}
)"));
  expect_picture_mean(inside, {std::exp(-1.4), std::exp(-9.8), std::exp(-28.0)}, kMediaPromise);
  const YamlScene glass(ray_job(16, 8, R"(
media: {dye: {absorption: [0.1, 0.7, 2]}}
atmosphere: dye
objects:
  ball: {shape: sphere, radius: 1, material: clear}
  lamp: {shape: rectangle, size: [9, 9], material: lamp, at: [0, 0, -4], transform: [{rotate_x: 90}], emit: {radiance: 1}}
)"));
  expect_picture_mean(glass, {std::exp(-0.6), std::exp(-4.2), std::exp(-12.0)}, kMediaPromise);
}

}  // namespace
}  // namespace hyades::test
