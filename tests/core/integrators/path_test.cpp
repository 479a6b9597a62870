// The path integrator, ray by ray, in scenes where every sample's value is known.
#include "core/integrators/path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/core/integrators/scene_of.h"
#include "tests/support/means.h"

namespace hyades::core {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

/// Three mirrors at right angles under a sky of 1: whatever comes along (-1, -2, -3) leaves after
/// exactly three reflections, with half the light lost at each.
const std::string kCorner = R"yaml(
materials: {half: {type: mirror, color: 0.5}}
objects:
  floor: {shape: rectangle, size: [9, 9], at: [4.5, 0, 4.5], material: half}
  back: {shape: rectangle, size: [9, 9], transform: [{rotate_x: 90}], at: [4.5, 4.5, 0], material: half}
  side: {shape: rectangle, size: [9, 9], transform: [{rotate_z: -90}], at: [0, 4.5, 4.5], material: half}
environment: {color: 1}
)yaml";

Ray into_the_corner() {
  const Vec3 direction(-1.0F, -2.0F, -3.0F);
  Ray ray;
  ray.origin = Vec3(1.0F, 2.2F, 3.5F);
  ray.direction = direction / std::sqrt(14.0F);
  return ray;
}

/// Sample number `index` along `ray`.
PixelSample trace(const TestScene& test, const Ray& ray, uint32_t index, Workspace& work) {
  const auto integrator = make_integrator(test.job.integrator);
  const auto sampler = make_sampler(SamplerKind::independent);
  sampler->start({1, 1, {0, 0}, index});
  return integrator->sample(*test.scene, ray, *sampler, work);
}

PixelSample trace(const TestScene& test, const Ray& ray, uint32_t index = 0) {
  Workspace work;
  return trace(test, ray, index, work);
}

std::string with_path(const std::string& scene, const std::string& settings) {
  return scene + "integrator: {type: path, " + settings + "}\n";
}

TEST(PathIntegrator, TheDepthLimitCountsScatteringEvents) {
  for (const int depth : {0, 1, 2, 3, 4}) {
    const TestScene test(
        with_path(kCorner, "roulette_depth: 100, max_depth: " + std::to_string(depth)));
    EXPECT_EQ(trace(test, into_the_corner()).radiance, Rgb(depth < 3 ? 0.0F : 0.125F)) << depth;
  }
}

TEST(PathIntegrator, CountsRaysAndBounces) {
  const TestScene test(with_path(kCorner, "roulette_depth: 100"));
  Workspace work;
  trace(test, into_the_corner(), 0, work);
  EXPECT_EQ(work.bounces, 3U);
  EXPECT_EQ(work.rays, 4U) << "mirrors need no shadow rays";
}

TEST(PathIntegrator, RouletteBeginsAtItsDepth) {
  const TestScene late(with_path(kCorner, "roulette_depth: 4"));
  const TestScene early(with_path(kCorner, "roulette_depth: 3"));
  int ended = 0;
  for (uint32_t i = 0; i < 64; ++i) {
    EXPECT_EQ(trace(late, into_the_corner(), i).radiance.x, 0.125F);
    if (trace(early, into_the_corner(), i).radiance.x == 0.0F) ++ended;
  }
  EXPECT_GT(ended, 40) << "an eighth of the paths goes on";
}

TEST(PathIntegrator, RouletteDoesNotBias) {
  for (const char* depth : {"1", "2", "3"}) {
    const TestScene test(with_path(kCorner, std::string("roulette_depth: ") + depth));
    test::Moments moments;
    for (uint32_t i = 0; i < 200'000; ++i) {
      moments.add(double{trace(test, into_the_corner(), i).radiance.x});
    }
    EXPECT_TRUE(test::mean_is(moments, 0.125, {.tests = 3, .relative_error = 0.05})) << depth;
  }
}

TEST(PathIntegrator, ClampingSparesWhatComesByOneBounce) {
  std::string bright = kCorner;
  bright.replace(bright.find("{color: 1}"), 10, "{color: 8}");
  const TestScene test(with_path(bright, "roulette_depth: 100, clamp: 0.75"));
  Ray ray = into_the_corner();
  ray.direction = Vec3(0.0F, 0.6F, 0.8F);
  EXPECT_EQ(trace(test, ray).radiance, Rgb(8.0F)) << "seen directly";
  ray.direction = Vec3(0.0F, -0.6F, 0.8F);
  EXPECT_EQ(trace(test, ray).radiance, Rgb(4.0F)) << "by one mirror";
  ray.direction = Vec3(0.0F, -0.6F, -0.8F);
  EXPECT_EQ(trace(test, ray).radiance, Rgb(0.75F)) << "by two, 2 unclamped";
  EXPECT_EQ(trace(TestScene(with_path(bright, "roulette_depth: 100")), ray).radiance, Rgb(2.0F));
}

TEST(PathIntegrator, NullSurfacesAreNoEvents) {
  std::string veiled = kCorner;
  veiled.insert(veiled.find("half:"), "nothing: {type: 'null'}, ");
  veiled.insert(veiled.find("environment"),
                "  veil: {shape: sphere, radius: 0.5, at: [1, 2.2, 3.5], material: nothing}\n");
  const TestScene test(with_path(veiled, "roulette_depth: 100, max_depth: 3"));
  Workspace work;
  const PixelSample sample = trace(test, into_the_corner(), 0, work);
  EXPECT_EQ(sample.radiance, Rgb(0.125F));
  EXPECT_EQ(work.bounces, 3U);
  EXPECT_EQ(sample.alpha, 1.0F);
}

TEST(PathIntegrator, APointLightOverAMattFloor) {
  const TestScene test(with_path(R"yaml(
materials: {floor: {type: lambert, color: 0.6}}
objects: {floor: {shape: rectangle, size: [9, 9], material: floor}}
lights: {bulb: {type: point, at: [0, 2, 0], power: 12}}
)yaml",
                                 "max_depth: 1"));
  for (const float x : {0.0F, 1.5F}) {
    Ray ray;
    ray.origin = Vec3(x, 1.0F, 0.0F);
    ray.direction = Vec3(0.0F, -1.0F, 0.0F);
    // albedo / pi  power / (4 pi)  cos / distance^2, with cos = 2 / distance
    const double distance = std::sqrt(4.0 + double{x} * double{x});
    const double expected = 0.6 / M_PI * 12.0 / (4.0 * M_PI) * 2.0 / std::pow(distance, 3.0);
    EXPECT_NEAR(double{trace(test, ray).radiance.x}, expected, 1e-5 * expected) << x;
  }
}

// A lamp over a floor is found by choosing it and by bouncing off the floor; both together count
// once.
TEST(PathIntegrator, LightIsCountedOnceHoweverItIsFound) {
  const TestScene test(with_path(R"yaml(
materials: {floor: {type: lambert, color: 0.6}, dark: {type: black}}
objects:
  floor: {shape: rectangle, size: [9, 9], material: floor}
  lamp: {shape: sphere, radius: 1, at: [0, 2, 0], material: dark, emit: {radiance: 3}}
)yaml",
                                 "max_depth: 1"));
  Ray ray;
  ray.origin = Vec3(0.0F, 0.5F, 0.0F);
  ray.direction = Vec3(0.0F, -1.0F, 0.0F);
  test::Moments moments;
  for (uint32_t i = 0; i < 40'000; ++i) moments.add(double{trace(test, ray, i).radiance.x});
  // A sphere over its own foot point: irradiance pi L (r / d)^2.
  const double expected = 0.6 * 3.0 / 4.0;
  EXPECT_TRUE(test::mean_is(moments, expected));
}

// Radiance is squeezed by eta^2 on its way into glass and back on its way out: seen in a layer of
// glass over a lamp, that is nothing but Fresnel's losses.
TEST(PathIntegrator, ALampThroughAPaneLosesFresnelsShareOnly) {
  const TestScene test(with_path(R"yaml(
materials: {glass: {type: dielectric, ior: 1.5}, dark: {type: black}}
objects:
  pane: {shape: box, size: [9, 0.5, 9], at: [0, 1, 0], material: glass}
  lamp: {shape: rectangle, size: [9, 9], material: dark, emit: {radiance: 1}}
)yaml",
                                 "max_depth: 100, roulette_depth: 100"));
  Ray ray;
  ray.origin = Vec3(0.0F, 3.0F, 0.0F);
  ray.direction = Vec3(0.0F, -1.0F, 0.0F);
  test::Moments moments;
  for (uint32_t i = 0; i < 100'000; ++i) moments.add(double{trace(test, ray, i).radiance.x});
  // Two faces of reflectance r = 0.04 and all that goes to and fro between them: (1 - r) / (1 + r).
  const double expected = 0.96 / 1.04;
  EXPECT_TRUE(test::mean_is(moments, expected));
}

// Where the light begins within the glass, the factor stays: n^2 = 2.25 times less comes out of it.
TEST(PathIntegrator, ALampInGlassIsSqueezedOnItsWayOut) {
  const TestScene test(with_path(R"yaml(
materials: {glass: {type: dielectric, ior: 1.5}, dark: {type: black}}
objects:
  block: {shape: box, size: [9, 2, 9], material: glass}
  lamp: {shape: rectangle, size: [8, 8], material: dark, emit: {radiance: 1}}
)yaml",
                                 "max_depth: 100, roulette_depth: 100"));
  Ray ray;
  ray.origin = Vec3(0.0F, 3.0F, 0.0F);
  ray.direction = Vec3(0.0F, -1.0F, 0.0F);
  test::Moments moments;
  for (uint32_t i = 0; i < 40'000; ++i) moments.add(double{trace(test, ray, i).radiance.x});
  EXPECT_TRUE(test::mean_is(moments, 0.96 / 2.25));
}

TEST(PathIntegrator, LayersAreThoseOfTheFirstSurfaceAlbedoOfTheFirstThatIsNoMirror) {
  const TestScene test(with_path(R"yaml(
materials: {mirror: {type: mirror, color: [0.5, 0.25, 1]}, wall: {type: lambert, color: [0.8, 0.8, 0.4]}}
objects:
  floor: {shape: rectangle, size: [9, 9], material: mirror}
  wall: {shape: rectangle, size: [9, 9], transform: [{rotate_x: 90}], at: [0, 0, -2], material: wall}
camera: {look_from: [0, 1, 3], look_at: [0, 1, 0]}
)yaml",
                                 "max_depth: 4"));
  Ray ray;
  ray.origin = Vec3(0.0F, 1.0F, 1.0F);
  ray.direction = Vec3(0.0F, -std::sqrt(0.5F), -std::sqrt(0.5F));
  const PixelSample sample = trace(test, ray);
  EXPECT_EQ(sample.alpha, 1.0F);
  EXPECT_NEAR(sample.depth, 3.0F, 1e-5F) << "the floor at z = 0, along the camera's axis";
  EXPECT_NEAR(sample.normal.y, 1.0F, 1e-6F);
  EXPECT_NEAR(sample.albedo.x, 0.4F, 1e-6F);
  EXPECT_NEAR(sample.albedo.y, 0.2F, 1e-6F);
  EXPECT_NEAR(sample.albedo.z, 0.4F, 1e-6F);
}

TEST(PathIntegrator, TellsThePathInWords) {
  const TestScene test(with_path(kCorner, "roulette_depth: 100"));
  PathLog log;
  Workspace work;
  work.log = &log;
  const PixelSample told = trace(test, into_the_corner(), 7, work);
  EXPECT_EQ(told.radiance, trace(test, into_the_corner(), 7).radiance) << "telling changes nothing";
  ASSERT_EQ(log.lines.size(), 8U) << testing::PrintToString(log.lines);
  for (const size_t i : {0U, 2U, 4U}) {
    EXPECT_THAT(log.lines[i], StartsWith("  meets '"));
    EXPECT_THAT(log.lines[i + 1], StartsWith("  specular reflection along ("));
  }
  EXPECT_THAT(log.lines[0], HasSubstr("'side'"));
  EXPECT_EQ(log.lines[6], "  leaves the scene");
  EXPECT_EQ(log.lines[7], "    light arrives: (0.125, 0.125, 0.125)");

  const TestScene roulette(with_path(kCorner, "roulette_depth: 1"));
  PathLog ends;
  work.log = &ends;
  for (uint32_t i = 0; i < 20; ++i) trace(roulette, into_the_corner(), i, work);
  EXPECT_THAT(ends.lines, Contains("  ended by roulette"));

  const TestScene lit(with_path(R"yaml(
objects: {floor: {shape: rectangle, size: [9, 9]}}
lights: {bulb: {type: point, at: [0, 2, 0]}}
)yaml",
                                "max_depth: 1"));
  PathLog direct;
  work.log = &direct;
  Ray down;
  down.origin = Vec3(0.0F, 1.0F, 0.0F);
  down.direction = Vec3(0.0F, -1.0F, 0.0F);
  trace(lit, down, 0, work);
  EXPECT_THAT(direct.lines, Contains("    chooses light 'bulb', weight 1"));
}

TEST(Integrators, AreMadeByName) {
  EXPECT_THAT(integrator_names(), Contains("path"));
  for (const std::string& name : integrator_names()) {
    IntegratorDesc desc;
    desc.type = name;
    EXPECT_NE(make_integrator(desc), nullptr) << name;
  }
  IntegratorDesc unknown;
  unknown.type = "guesswork";
  EXPECT_EQ(make_integrator(unknown), nullptr);
}

}  // namespace
}  // namespace hyades::core
