#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "core/base/color.h"
#include "core/job/expression.h"
#include "core/job/expression_functions.h"
#include "core/job/layers.h"
#include "core/job/output_path.h"
#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

Job read_values(const std::string& body) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  Job job = parse_job("hyades: 1\n" + body, "shot.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return job;
}

double value_of(const std::string& text, double t = 0.0, double frame = 1.0) {
  const auto compiled = compile_expression(text);
  EXPECT_TRUE(compiled.ok()) << text << ": " << (compiled.ok() ? "" : compiled.error().message);
  return compiled.ok() ? (*compiled)->evaluate({t, frame}) : NAN;
}

TEST(Expression, OperatorsAndPrecedence) {
  EXPECT_EQ(value_of("1 + 2 * 3"), 7.0);
  EXPECT_EQ(value_of("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(value_of("2 ^ 3 ^ 2"), 512.0);
  EXPECT_EQ(value_of("-2 ^ 2"), -4.0);
  EXPECT_EQ(value_of("(-2) ^ 3"), -8.0);
  EXPECT_EQ(value_of("2 ^ -2"), 0.25);
  EXPECT_EQ(value_of("7 - 3 - 2"), 2.0);
  EXPECT_EQ(value_of("12 / 2 / 3"), 2.0);
  EXPECT_EQ(value_of("3 - -2"), 5.0);
  EXPECT_EQ(value_of("1 < 2 && 3 >= 3"), 1.0);
  EXPECT_EQ(value_of("1 == 2 || 1 != 1"), 0.0);
  EXPECT_EQ(value_of("t > 1 ? 10 : 20", 2.0), 10.0);
  EXPECT_EQ(value_of("t > 1 ? 10 : 20", 1.0), 20.0);
  EXPECT_EQ(value_of("frame", 0.0, 12.0), 12.0);
  EXPECT_EQ(value_of("1e3 + .5 + 2."), 1002.5);
}

TEST(Expression, Functions) {
  EXPECT_NEAR(value_of("sin(pi / 6)"), 0.5, 1e-7);
  EXPECT_NEAR(value_of("cos(pi)"), -1.0, 1e-7);
  EXPECT_NEAR(value_of("tan(pi / 4)"), 1.0, 1e-6);
  EXPECT_NEAR(value_of("asin(1) - acos(0)"), 0.0, 1e-6);
  EXPECT_NEAR(value_of("atan(1)"), 0.7853981634, 1e-7);
  EXPECT_NEAR(value_of("atan2(1, -1)"), 2.356194490, 1e-6);
  EXPECT_NEAR(value_of("exp(1) - e"), 0.0, 1e-6);
  EXPECT_NEAR(value_of("log(e)"), 1.0, 1e-6);
  EXPECT_EQ(value_of("sqrt(16) + abs(-3)"), 7.0);
  EXPECT_EQ(value_of("floor(-1.5) + ceil(1.2) + round(2.5)"), 3.0);
  EXPECT_EQ(value_of("min(3, 2) + max(3, 2)"), 5.0);
  EXPECT_EQ(value_of("pow(2, 10)"), 1024.0);
  EXPECT_NEAR(value_of("pow(2, 0.3)"), 1.2311444, 1e-6);
  EXPECT_EQ(value_of("mod(-1, 3)"), 2.0);
  EXPECT_EQ(value_of("clamp(5, 0, 1) + clamp(-5, 0, 1)"), 1.0);
  EXPECT_EQ(value_of("lerp(10, 20, 0.25)"), 12.5);
  EXPECT_EQ(value_of("smoothstep(0, 2, 1)"), 0.5);
  EXPECT_EQ(value_of("smoothstep(0, 2, 9)"), 1.0);
}

TEST(Expression, SineDoesNotJitterInLongAnimations) {
  // 40,000 s at 30 rad/s: as a float the argument would be off by 0.06 rad.
  EXPECT_NEAR(value_of("sin(30 * t)", 40000.01), std::sin(30.0 * 40000.01), 2e-7);
}

TEST(Expression, NoiseIsBoundedSmoothAndZeroAtWholeNumbers) {
  double least = 0.0;
  double most = 0.0;
  double sum = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double x = -500.0 + i * 0.01;
    const double n = expression::noise(x);
    least = std::min(least, n);
    most = std::max(most, n);
    sum += n;
    ASSERT_LE(std::abs(expression::noise(x + 1e-6) - n), 1e-5);
  }
  EXPECT_GE(least, -1.0);
  EXPECT_LE(most, 1.0);
  EXPECT_LT(least, -0.5);
  EXPECT_GT(most, 0.5);
  EXPECT_NEAR(sum / 100000.0, 0.0, 0.05);
  for (int i = -20; i < 20; ++i) EXPECT_EQ(expression::noise(i), 0.0);
  EXPECT_TRUE(std::isnan(expression::noise(INFINITY)));
  EXPECT_EQ(expression::noise(1e300), 0.0);
}

TEST(Expression, ThreadsMayShareOne) {
  const auto compiled = compile_expression("t * 2 + frame");
  ASSERT_TRUE(compiled.ok());
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&, k] {
      for (int i = 0; i < 5000; ++i) {
        const double t = k * 10000 + i;
        if ((*compiled)->evaluate({t, 3.0}) != 2.0 * t + 3.0) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Animated, EasesBetweenKeysAndHoldsOutside) {
  const auto at = [](const char* ease, float frame) {
    const Job job = read_values(
        std::string("frames: 1-20\ncamera: {fov: {keys: {12: 40, 2: 20}, ease: ") + ease + "}}\n");
    return job.camera.fov.at({0.0, frame});
  };
  EXPECT_FLOAT_EQ(at("linear", 0.0F), 20.0F);
  EXPECT_FLOAT_EQ(at("linear", 4.5F), 25.0F);
  EXPECT_FLOAT_EQ(at("linear", 30.0F), 40.0F);
  EXPECT_FLOAT_EQ(at("smooth", 4.5F), 20.0F + 20.0F * 0.15625F);
  EXPECT_FLOAT_EQ(at("step", 11.9F), 20.0F);
  EXPECT_FLOAT_EQ(at("step", 12.0F), 40.0F);
  EXPECT_FLOAT_EQ(at("in", 4.5F), 20.0F + 20.0F * 0.0625F);
  EXPECT_FLOAT_EQ(at("out", 4.5F), 20.0F + 20.0F * 0.4375F);
}

TEST(Animated, ComponentsMixNumbersAndExpressions) {
  const Job job = read_values(
      "frames: {range: 1-48, fps: 24}\nobjects: {a: {shape: box, at: [7, \"= t\", "
      "\"= frame\"]}}\n");
  const Vec3 at = job.objects[0].at.at(job.time_of(25));
  EXPECT_EQ(at, Vec3(7.0F, 1.0F, 25.0F));
  EXPECT_EQ(job.objects[0].at.at(job.time_of(1)), Vec3(7.0F, 0.0F, 1.0F));
}

TEST(Animated, OneNumberScalesAllAxes) {
  const Job job = read_values(
      "objects:\n"
      "  a: {shape: box, transform: [{scale: 2}, {scale: [1, 2, 3]}, {scale: \"= frame\"},"
      " {scale: {keys: {1: 5}}}]}\n");
  const TransformList& steps = job.objects[0].transform;
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0].vector.constant, Vec3(2.0F));
  EXPECT_EQ(steps[1].vector.constant, Vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(steps[2].vector.at(job.time_of(4)), Vec3(4.0F));
  EXPECT_EQ(steps[3].vector.at(job.time_of(4)), Vec3(5.0F));
}

TEST(Transform, MatrixIsWrittenRowByRow) {
  const Job job = read_values(
      "objects: {a: {shape: box, transform: [{matrix: [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, "
      "0, 1]}]}}\n");
  EXPECT_EQ(transform_point(job.objects[0].transform[0].matrix, Vec3(1.0F)),
            Vec3(6.0F, 7.0F, 8.0F));
}

TEST(Color, EveryForm) {
  const auto color = [](const std::string& text) {
    const Job job = read_values("frames: 1-3\nenvironment: {color: " + text + "}\n");
    return job.environment->color.at(job.time_of(2));
  };
  EXPECT_EQ(color("0.25"), Rgb(0.25F));
  EXPECT_EQ(color("[1, 2, 3]"), Rgb(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(color("\"#ff8000\""), *parse_hex_color("#ff8000"));
  EXPECT_EQ(color("\"#f80\""), *parse_hex_color("#f80"));
  EXPECT_EQ(color("3200K"), blackbody_color(3200.0F));
  EXPECT_EQ(color("\"= frame\""), Rgb(2.0F));
  EXPECT_EQ(color("[1, \"= frame\", 0]"), Rgb(1.0F, 2.0F, 0.0F));
  EXPECT_EQ(color("{keys: {1: 0, 3: [2, 4, 6]}}"), Rgb(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(color("{keys: {1: \"#000\", 3: 1}}"), Rgb(0.5F));
}

TEST(Texture, WrittenInPlaceGetsANameOfItsOwn) {
  const Job job = read_values(
      "materials:\n"
      "  a: {type: lambert, color: {type: checker, a: {type: fbm3d}, b: 0.5}}\n"
      "  b: {type: conductor, roughness: {type: perlin3d}}\n");
  ASSERT_EQ(job.textures.size(), 3U);
  EXPECT_EQ(job.textures[0].name, "(materials.a.color.a)");
  EXPECT_EQ(job.textures[1].name, "(materials.a.color)");
  EXPECT_EQ(std::get<textures::Checker>(job.textures[1].kind).a.texture, "(materials.a.color.a)");
  EXPECT_EQ(std::get<LambertDesc>(job.materials[0].kind).color.texture, "(materials.a.color)");
  EXPECT_EQ(std::get<ConductorDesc>(job.materials[1].kind).roughness.texture,
            "(materials.b.roughness)");
}

TEST(Job, ShortForms) {
  const Job job = read_values("frames: 5\nfilm: {filter: box}\nintegrator: path\nunits: 2.5\n");
  EXPECT_EQ(job.frames.first, 5);
  EXPECT_EQ(job.frames.last, 5);
  EXPECT_EQ(job.film.filter.type, FilterKind::box);
  EXPECT_FLOAT_EQ(job.film.filter.radius, 0.5F);
  EXPECT_FLOAT_EQ(job.units, 2.5F);
  EXPECT_FLOAT_EQ(read_values("units: in\n").units, 0.0254F);
}

TEST(Job, DefaultOutputsCarryTheName) {
  const Job still = read_values("");
  ASSERT_EQ(still.outputs.size(), 2U);
  EXPECT_EQ(still.outputs[0].file, "shot.exr");
  EXPECT_EQ(still.outputs[1].file, "shot.png");
  const Job film = read_values("name: take-2\nframes: 1-9x4\n");
  EXPECT_EQ(film.outputs[0].file, "take-2.####.exr");
  EXPECT_EQ(film.frames.step, 4);
  EXPECT_EQ(read_values("outputs: []\n").outputs.size(), 0U);
}

TEST(Job, OutputsSayWhichLayersAFilmNeeds) {
  const Job job = read_values(
      "outputs: [{file: a.exr, layers: [beauty, depth]}, {file: b.exr, layers: "
      "[normal]}]\n");
  const LayerSet layers = needed_layers(job);
  EXPECT_TRUE(layers.depth);
  EXPECT_TRUE(layers.normal);
  EXPECT_FALSE(layers.albedo);
}

TEST(OutputPath, FillsInTheFrame) {
  EXPECT_EQ(output_path("a.####.exr", 7), "a.0007.exr");
  EXPECT_EQ(output_path("####/a.##.exr", 123), "0123/a.123.exr");
  EXPECT_EQ(output_path("a.exr", 7), "a.exr");
}

TEST(OutputPath, TellsWhatANameIsLikeByAllOfItsParts) {
  for (const char* plain : {"a.exr", "a/b.####.exr", "./a-b/c.d", "hyades/a"}) {
    EXPECT_EQ(output_name(plain), OutputName::plain) << plain;
  }
  for (const char* outside : {"/a", "..", "../a", "a/../b", "a/.."}) {
    EXPECT_EQ(output_name(outside), OutputName::outside) << outside;
  }
  for (const char* reserved :
       {".hyades", ".hyades/log", "./.hyades/a", "a/.hyades/fetched", "a/b/.hyades"}) {
    EXPECT_EQ(output_name(reserved), OutputName::reserved) << reserved;
  }
  for (const char* special : {".a", "a/.b/c", "-a", "a/-b/c", "a/.hyades-b/c"}) {
    EXPECT_EQ(output_name(special), OutputName::special) << special;
  }
}

}  // namespace
}  // namespace hyades::core
