#include "core/job/curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

constexpr const char* kJob = R"yaml(
hyades: 1
frames: {range: 1-9x2}
camera: {fov: {keys: {1: 20, 9: 60}}, look_from: ["= frame", 1, 5]}
materials: {red: {type: lambert, color: {keys: {1: [1, 0, 0], 9: [0, 0, 1]}, ease: smooth}}}
objects:
  ball: {shape: sphere, material: red, transform: [{scale: 2}, {rotate_y: "= 10 * frame"}]}
  pair: {group: {objects: {left: {shape: box, at: [1, "= frame / 2", 0]}}}}
)yaml";

Job read_curves(const std::string& text) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  Job job = parse_job(text, "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return job;
}

TEST(Curve, IsFoundByItsPathInTheJob) {
  const Job job = read_curves(kJob);
  const auto value = [&](const std::string& path, int32_t frame) {
    const auto curve = find_curve(job, path);
    EXPECT_TRUE(curve) << path;
    return curve ? (*curve)->at(job.time_of(frame)) : std::vector<float>{};
  };
  EXPECT_EQ(value("camera.fov", 5), std::vector<float>{40.0F});
  EXPECT_EQ(value("camera.look_from", 3), (std::vector<float>{3.0F, 1.0F, 5.0F}));
  EXPECT_EQ(value("materials.red.color", 5), (std::vector<float>{0.5F, 0.0F, 0.5F}));
  EXPECT_EQ(value("objects.ball.transform[0].scale", 1), (std::vector<float>{2.0F, 2.0F, 2.0F}));
  EXPECT_EQ(value("objects.ball.transform[1].rotate_y", 7), std::vector<float>{70.0F});
}

TEST(Curve, OfAnUnknownPathListsWhatThereIs) {
  const Job job = read_curves(kJob);
  const auto wrong = find_curve(job, "camera.fow");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("'camera.fow'"));
  EXPECT_THAT(wrong.error().message, HasSubstr("camera.fov, camera.look_from"));
  const auto nothing = find_curve(read_curves("hyades: 1\n"), "camera.fov");
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("no values"));
}

TEST(Curve, IsPrintedFrameByFrame) {
  const Job job = read_curves(kJob);
  EXPECT_EQ(curve_table(job, **find_curve(job, "camera.fov")),
            "camera.fov\n"
            "  ▁▃▅▆█  20 to 60\n"
            "   frame  value\n"
            "       1  20\n"
            "       3  30\n"
            "       5  40\n"
            "       7  50\n"
            "       9  60\n");
  EXPECT_THAT(curve_table(job, **find_curve(job, "objects.ball.transform[0].scale")),
              HasSubstr("does not change"));
}

float keyed(const std::string& options, double frame) {
  const Job job =
      read_curves("hyades: 1\ncamera: {fov: {keys: {1: 20, 5: 40, 9: 50}" + options + "}}\n");
  return job.camera.fov.at({0.0, frame});
}

TEST(Exposure, IsAddedToEachOutputAndLeavesFilmsAlone) {
  const std::string outputs = "outputs: [{file: a.png, exposure: 1}, {file: a.exr}]\n";
  const Job plain = read_curves("hyades: 1\n" + outputs);
  // Sunny 16: at f/16 and a time of one over the speed, 1.2 * 16^2 * 100 cd/m^2 are white.
  const std::string set = "camera: {exposure: {iso: 200, shutter: 0.005, efficacy: 120}}\n";
  const Job job = read_curves("hyades: 1\n" + set + outputs);
  ASSERT_EQ(job.outputs.size(), 2U);
  EXPECT_NEAR(job.outputs[0].exposure, 1.0F - std::log2(30720.0F / 120.0F), 1e-4F);
  // Previews of the EXR are shown with it.
  EXPECT_NEAR(job.outputs[1].exposure, -8.0F, 1e-4F);
  EXPECT_EQ(render_key(job, 1, {}), render_key(plain, 1, {}));
  const Job defaults = read_curves("hyades: 1\n" + set);
  EXPECT_NEAR(defaults.outputs[1].exposure, -8.0F, 1e-4F);
}

TEST(Keys, RepeatFromTheBeginningOrThereAndBack) {
  EXPECT_FLOAT_EQ(keyed("", 12.0), 50.0F);
  EXPECT_FLOAT_EQ(keyed(", repeat: loop", 11.0), 30.0F);
  EXPECT_FLOAT_EQ(keyed(", repeat: loop", -1.0), 45.0F);
  EXPECT_FLOAT_EQ(keyed(", repeat: mirror", 11.0), 45.0F);
  EXPECT_FLOAT_EQ(keyed(", repeat: mirror", 19.0), 30.0F);
  EXPECT_FLOAT_EQ(keyed(", repeat: mirror", -1.0), 30.0F);
}

TEST(Keys, OnASplineGoOnThroughEachOther) {
  EXPECT_FLOAT_EQ(keyed(", ease: spline", 1.0), 20.0F);
  EXPECT_FLOAT_EQ(keyed(", ease: spline", 5.0), 40.0F);
  const float before = keyed(", ease: spline", 5.0) - keyed(", ease: spline", 4.99);
  const float after = keyed(", ease: spline", 5.01) - keyed(", ease: spline", 5.0);
  EXPECT_GT(before, 0.02F);
  EXPECT_NEAR(before, after, 0.05F * before);
  for (double f = 1.0; f < 9.0; f += 0.1)
    EXPECT_LE(keyed(", ease: spline", f), keyed(", ease: spline", f + 0.1));
}

TEST(Rotation, TurnsEvenlyAlongTheShortestWay) {
  Animated<Vec4> turn(Vec4(0, 0, 0, 1));
  const float half = std::sqrt(0.5F);
  // A quarter turn about y; the same rotation of the other sign, and twice as long.
  turn.keys = {{1.0, Vec4(0, 0, 0, 1)}, {10.0, Vec4(0, -2.0F * half, 0, -2.0F * half)}};
  const Vec4 third = rotation_at(turn, {0.0, 4.0});
  EXPECT_NEAR(third.y, 0.258819F, 1e-5F);  // sin(15 degrees)
  EXPECT_NEAR(third.w, 0.965926F, 1e-5F);
  const Vec4 last = rotation_at(turn, {0.0, 20.0});
  EXPECT_NEAR(last.y * last.w, 0.5F, 1e-5F);
}

TEST(Rotation, IsRefusedWhereItIsNone) {
  for (const char* wrong : {"[0, 0, 0, 0]", "[1, 0, 0]", "1", "{keys: {1: [0, 0, 0]}}"}) {
    MemoryAssets assets;
    Diagnostics diagnostics;
    parse_job(std::string("hyades: 1\nobjects: {x: {shape: box, transform: [{rotate: "
                          "{quaternion: ") +
                  wrong + "}}]}}\n",
              "job.yaml", assets, diagnostics);
    EXPECT_THAT(diagnostics.to_string(), HasSubstr("expected a quaternion [x, y, z, w]")) << wrong;
  }
}

}  // namespace
}  // namespace hyades::core
