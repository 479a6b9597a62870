#include "core/render/frame_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <thread>

#include "core/render/render_frame.h"
#include "tests/core/integrators/scene_of.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

/// 20 samples: a whole batch and a short one.
const std::string kRoom = R"yaml(
film: {size: [24, 16], filter: {type: mitchell, radius: 1.5}}
sampling: {samples: 20, seed: 3}
camera: {look_from: [0, 1, 5], look_at: [0, 0.5, 0], fov: 40}
materials: {red: {type: glossy, color: [0.8, 0.2, 0.1]}}
objects:
  floor: {shape: rectangle, size: [6, 6]}
  ball: {shape: sphere, radius: 0.8, at: [0, 0.8, 0], material: red}
environment: {color: [0.4, 0.5, 0.6]}
)yaml";
constexpr PixelRect kWhole{0, 0, 24, 16};

struct TestRenderer {
  explicit TestRenderer(const std::string& yaml, const LayerSet& layers = {.depth = true})
      : test(yaml), renderer(test.scene, test.job, 1, layers) {}
  TestScene test;
  FrameRenderer renderer;
};

TEST(FrameRenderer, AFilmIsItsUnitAndNothingElse) {
  const TestRenderer room(kRoom);
  const Unit unit{1, {3, 2, 11, 9}, {1, 1}};
  const RenderedUnit done = room.renderer.render(unit);
  EXPECT_FALSE(done.stopped);
  EXPECT_EQ(done.film.window(), unit.tile);
  EXPECT_EQ(done.film.coverage().volume(), 56U);
  EXPECT_TRUE(done.film.coverage().contains({unit.tile, unit.batches}));
  EXPECT_EQ(done.counters.samples, 4 * 56U) << "the second batch holds what is left of 20";
  EXPECT_EQ(done.counters.bad_samples, 0U);
  EXPECT_GE(done.counters.rays, done.counters.samples);
  const int samples = done.film.layout().samples;
  EXPECT_EQ(done.film.sum(5, 5, samples), (Fixed128{0, 4}));
}

TEST(FrameRenderer, TilesAndBatchesAddUpToTheWhole) {
  const TestRenderer room(kRoom);
  const RenderedUnit whole = room.renderer.render({1, kWhole, {0, 2}});
  EXPECT_EQ(whole.counters.samples, 20U * 24 * 16);
  Film sum(room.renderer.layout(), kWhole);
  RenderCounters counters;
  for (const uint32_t batch : {1U, 0U}) {
    for (const PixelRect& tile :
         {PixelRect{13, 0, 24, 16}, PixelRect{0, 7, 13, 16}, PixelRect{0, 0, 13, 7}}) {
      const RenderedUnit part = room.renderer.render({1, tile, {batch, 1}});
      ASSERT_TRUE(sum.merge(part.film));
      counters.add(part.counters);
    }
  }
  EXPECT_EQ(sum.digest(), whole.film.digest());
  EXPECT_EQ(counters.samples, whole.counters.samples);
  EXPECT_EQ(counters.rays, whole.counters.rays);
  EXPECT_EQ(counters.bounces, whole.counters.bounces);
}

TEST(FrameRenderer, ThePlanOfAFrameChangesNoBit) {
  const TestRenderer room(kRoom);
  const std::string digest = room.renderer.render({1, kWhole, {0, 2}}).film.digest();
  for (const RenderFrameOptions& options :
       {RenderFrameOptions{}, RenderFrameOptions{3, 5, 1, true}, RenderFrameOptions{2, 16, 2}}) {
    const RenderedFrame frame = render_frame(room.renderer, kWhole, 20, 1, options);
    EXPECT_EQ(frame.film.digest(), digest) << options.threads;
    EXPECT_EQ(frame.counters.samples, 20U * 24 * 16);
  }
}

TEST(FrameRenderer, GivesUpWhenToldTo) {
  const TestRenderer room(kRoom);
  const std::atomic<bool> stop{true};
  const RenderedUnit done = room.renderer.render({1, kWhole, {0, 2}}, &stop);
  EXPECT_TRUE(done.stopped);
  EXPECT_EQ(done.film.coverage().volume(), 0U);
  EXPECT_EQ(done.counters.samples, 0U);
  const std::atomic<bool> go_on{false};
  EXPECT_FALSE(room.renderer.render({1, {0, 0, 2, 2}, {0, 1}}, &go_on).stopped);
}

TEST(FrameRenderer, DoesNotFinishARowOfLongPathsWhenToldToStop) {
  // In a closed mirror every path goes on to its last bounce: a pixel takes a tenth of a second.
  const TestRenderer mirror(R"yaml(
film: {size: [256, 4], filter: box}
sampling: {samples: 16}
integrator: {type: path, max_depth: 65536, roulette_depth: 65536}
camera: {look_from: [0, 0, 0.5], look_at: [0, 0, 0], fov: 40}
materials: {mirror: {type: mirror}}
objects: {ball: {shape: sphere, radius: 1, material: mirror}}
)yaml");
  const PixelRect row{0, 0, 256, 1};
  std::atomic<bool> stop{false};
  std::atomic<uint64_t> samples{0};
  std::thread hand([&] {
    while (samples == 0) std::this_thread::yield();
    stop = true;
  });
  const RenderedUnit done = mirror.renderer.render({1, row, {0, 1}}, &stop, nullptr, &samples);
  hand.join();
  EXPECT_TRUE(done.stopped);
  EXPECT_LT(samples, 16U * 128);
  EXPECT_EQ(done.film.coverage().volume(), 0U) << "no part of a batch";
}

TEST(FrameRenderer, SamplesThatAreTooBrightAreCountedAndLeftOut) {
  // A lamp beyond all bounds on the left of the picture; the rest is dark.
  const TestRenderer room(R"yaml(
film: {size: [8, 4], filter: box}
sampling: {samples: 16}
camera: {look_from: [0, 0, 5], look_at: [0, 0, 0], fov: 40}
materials: {dark: {type: black}}
objects:
  lamp: {shape: rectangle, size: [20, 20], transform: [{rotate_x: 90}], at: [-10, 0, 0], material: dark, emit: {radiance: 1.0e+18}}
)yaml");
  const PixelRect all{0, 0, 8, 4};
  const RenderedUnit done = room.renderer.render({1, all, {0, 1}});
  EXPECT_EQ(done.counters.samples, 16U * 32) << "bad ones are samples too";
  EXPECT_EQ(done.counters.bad_samples, 16U * 16) << "the left half";
  ASSERT_EQ(done.counters.examples.size(), 8U);
  EXPECT_EQ(done.counters.examples[7].pixel, Vec2i(0, 0));
  EXPECT_EQ(done.counters.examples[7].sample, 7U);
  PathLog log;
  const PixelSample bright = room.renderer.replay({0, 0}, 7, log);
  EXPECT_TRUE(std::isfinite(bright.radiance.x));
  EXPECT_EQ(why_not_counted(bright), "its radiance is beyond 3.44e+10");
  EXPECT_FALSE(why_not_counted(room.renderer.replay({7, 0}, 7, log)));
  EXPECT_TRUE(done.film.check());
  const Image picture = done.film.normalised();
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_EQ(picture.at(x, y, 0), 0.0F) << x << " " << y;
  }
  RenderCounters sum = done.counters;
  sum.add(done.counters);
  EXPECT_EQ(sum.bad_samples, 2U * 16 * 16);
  EXPECT_EQ(sum.examples.size(), 8U) << "a few are enough";
}

TEST(FrameRenderer, WhatIsWrongWithASampleIsTold) {
  PixelSample sample;
  sample.radiance = Vec3(kMaxSample, -kMaxSample, 0.0F);
  EXPECT_EQ(why_not_counted(sample), std::nullopt);
  sample.normal.y = std::nextafter(kMaxSample, kInfinity);
  EXPECT_EQ(why_not_counted(sample), "its normal is beyond 3.44e+10");
  sample.albedo.z = std::nanf("");
  EXPECT_EQ(why_not_counted(sample), "its albedo is not finite");
  sample.radiance.x = -kInfinity;
  EXPECT_EQ(why_not_counted(sample), "its radiance is not finite");
  EXPECT_EQ(bad_sample_words(), "not finite or beyond 3.44e+10");
}

TEST(FrameRenderer, AReplayIsTheSampleThatWasRendered) {
  std::string one = kRoom;
  one.replace(one.find("samples: 20"), 11, "samples: 1");
  const TestRenderer room(one);
  const Film film = room.renderer.render({1, kWhole, {0, 1}}).film;
  for (const Vec2i& pixel : {Vec2i(0, 0), Vec2i(12, 8), Vec2i(23, 15)}) {
    PathLog log;
    const PixelSample sample = room.renderer.replay(pixel, 0, log);
    EXPECT_FALSE(log.lines.empty());
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(film.sum(pixel.x, pixel.y, c), to_fixed(sample.radiance[c]));
    }
    EXPECT_EQ(film.minimum(pixel.x, pixel.y, film.layout().depth), sample.depth);
  }
  PathLog first;
  PathLog second;
  room.renderer.replay({12, 8}, 0, first);
  room.renderer.replay({12, 8}, 1, second);
  EXPECT_NE(first.lines, second.lines) << "another sample is another path";
  EXPECT_THAT(first.lines[0], HasSubstr("meets 'ball'"));
}

TEST(FrameRenderer, RendersTheCropOrEverything) {
  FilmDesc film;
  film.width = 30;
  film.height = 20;
  EXPECT_EQ(render_window(film), (PixelRect{0, 0, 30, 20}));
  film.crop = PixelRect{4, 5, 6, 7};
  EXPECT_EQ(render_window(film), (PixelRect{4, 5, 6, 7}));
}

// Mitchell's filter has weights other than 1. Within a wall all round alpha is the weight.
TEST(FrameRenderer, FiltersWeighEveryLayerOfASample) {
  const TestRenderer inside(R"yaml(
film: {size: [4, 4], filter: {type: mitchell, radius: 2}}
sampling: {samples: 16}
integrator: {type: path, max_depth: 0}
materials: {grey: {type: lambert, color: 0.5}}
objects: {wall: {shape: box, size: [18, 18, 18], material: grey, emit: {radiance: 2, two_sided: true}}}
)yaml",
                            {.depth = true, .albedo = true, .normal = true});
  PathLog log;
  bool weighed = false;
  for (uint32_t s = 0; s < 16; ++s) {
    const PixelSample sample = inside.renderer.replay({1, 1}, s, log);
    weighed = weighed || std::abs(sample.alpha - 1.0F) > 0.01F;
    EXPECT_NEAR(sample.radiance.x, 2.0F * sample.alpha, 1e-5F);
    EXPECT_NEAR(std::sqrt(glm::dot(sample.normal, sample.normal)), std::abs(sample.alpha), 1e-5F);
  }
  EXPECT_TRUE(weighed);
}

}  // namespace
}  // namespace hyades::core
