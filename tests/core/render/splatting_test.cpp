#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/job/layers.h"
#include "core/render/render_frame.h"
#include "tests/core/integrators/scene_of.h"

namespace hyades::core {
namespace {

const std::string kEmpty = R"yaml(
film: {size: [24, 16], crop: [2, 1, 22, 15], filter: {type: mitchell, radius: 1.5}}
sampling: {samples: 40, seed: 3}
objects: {ball: {shape: sphere}}
)yaml";
constexpr PixelRect kCrop{2, 1, 22, 15};

/// Two splats of value (2, 1, 0) anywhere around the film, and radiance (0, 0, 1).
class Splatter final : public Integrator {
 public:
  PixelSample sample(const Scene& scene, const Ray& /*ray*/, Sampler& sampler,
                     Workspace& work) const override {
    PixelSample result;
    result.radiance = Rgb(0.0F, 0.0F, 1.0F);
    EXPECT_TRUE(work.splats.empty()) << "left over from another sample";
    EXPECT_EQ(scene.window, kCrop);
    const Vec2 frame(scene.resolution);
    for (int i = 0; i < 2; ++i) {
      // Over the frame with two pixels all around, so that each has one splat to a pixel.
      const Vec2 at = sampler.next_2d() * (frame + Vec2(4.0F)) - Vec2(2.0F);
      const float density = 2.0F / ((frame.x + 4.0F) * (frame.y + 4.0F));
      work.splats.push_back({at, Rgb(2.0F, 1.0F, 0.0F) / density});
    }
    return result;
  }
};

struct Rendering {
  explicit Rendering(std::unique_ptr<Integrator> integrator, const std::string& yaml = kEmpty)
      : test(yaml),
        renderer(test.scene, test.job, 1, {.depth = true, .splats = true}, std::move(integrator)) {}
  TestScene test;
  FrameRenderer renderer;
};

TEST(Splatting, JobsThatSplatHaveFilmsForIt) {
  Job job;
  EXPECT_FALSE(needed_layers(job).splats);
  for (const char* type : {"bdpt", "mlt"}) {
    job.integrator.type = type;
    EXPECT_TRUE(needed_layers(job).splats);
  }
}

TEST(Splatting, ThePlanOfAFrameChangesNoBit) {
  const Rendering all(std::make_unique<Splatter>());
  const RenderedUnit whole = all.renderer.render({1, kCrop, {0, 3}});
  EXPECT_EQ(whole.counters.bad_samples, 0U);
  EXPECT_EQ(whole.film.splats().region(), kCrop);
  const std::string digest = whole.film.digest();
  for (const RenderFrameOptions& options :
       {RenderFrameOptions{}, RenderFrameOptions{3, 5, 1, true}, RenderFrameOptions{2, 16, 2}}) {
    const RenderedFrame frame = render_frame(all.renderer, kCrop, 40, 1, options);
    EXPECT_TRUE(frame.film.check());
    EXPECT_EQ(frame.film.digest(), digest) << options.threads;
  }
  const RenderedUnit part = all.renderer.render({1, {4, 4, 6, 6}, {1, 1}});
  EXPECT_EQ(part.film.window(), (PixelRect{4, 4, 6, 6}));
  EXPECT_EQ(part.film.splats().region(), kCrop);
  EXPECT_GT(part.film.splats().count(), 50U) << "splats are anywhere";
}

// 22,400 splats on 440 pixels, 51 to each: the mean over 280 of them has a standard error below 1
// %.
TEST(Splatting, ThePictureIsTheDensityOfSplatsTimesTheirValue) {
  const Rendering all(std::make_unique<Splatter>());
  const RenderedFrame frame = render_frame(all.renderer, kCrop, 40, 1);
  const Image picture = frame.film.normalised();
  double red = 0.0;
  double green = 0.0;
  double variance = 0.0;
  double blue = 0.0;
  const int first_variance = picture.channel_count() - 4;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      red += double{picture.at(x, y, 0)} / 280;
      green += double{picture.at(x, y, 1)} / 280;
      blue += double{picture.at(x, y, 2)} / 280;
      variance += double{picture.at(x, y, first_variance)} / 280;
    }
  }
  EXPECT_NEAR(red, 2.0, 0.05);
  EXPECT_NEAR(green, 0.5 * red, 1e-5);
  EXPECT_NEAR(blue, 1.0, 0.02) << "of camera paths, weighed by the filter";
  // Of single pixels around that mean.
  double spread = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double off = double{picture.at(x, y, 0)} - red;
      spread += off * off / 279;
    }
  }
  EXPECT_NEAR(variance / spread, 1.0, 0.4);
}

TEST(Splatting, SplatsOfASampleThatDoesNotCountDoNotEither) {
  class Bad final : public Integrator {
   public:
    PixelSample sample(const Scene& /*scene*/, const Ray& /*ray*/, Sampler& sampler,
                       Workspace& work) const override {
      PixelSample result;
      if (sampler.next_1d() < 0.5F) result.radiance.x = kInfinity;
      if (result.radiance.x == 0.0F) return result;
      work.splats.push_back({{8.0F, 8.0F}, Rgb(1.0F)});
      return result;
    }
  };
  const Rendering bad(std::make_unique<Bad>());
  const RenderedUnit done = bad.renderer.render({1, kCrop, {0, 1}});
  EXPECT_NEAR(static_cast<double>(done.counters.bad_samples), 280 * 8, 300);
  EXPECT_TRUE(done.film.splats().empty());
}

TEST(Splatting, SplatsThatDoNotCountAreCountedAndLeftOut) {
  class Bad final : public Integrator {
   public:
    PixelSample sample(const Scene& /*scene*/, const Ray& /*ray*/, Sampler& /*sampler*/,
                       Workspace& work) const override {
      const Vec2 at(8.0F, 8.0F);
      for (const Splat& splat :
           {Splat{at, Rgb(1.0F, kInfinity, 1.0F)}, Splat{at, Rgb(std::nanf(""))},
            Splat{at, Rgb(1e17F)}, Splat{{std::nanf(""), 1.0F}, Rgb(1.0F)},  // four bad ones
            Splat{at, Rgb(0.0F)}, Splat{{-100.0F, 8.0F}, Rgb(1.0F)},
            Splat{{100.0F, 8.0F}, Rgb(1.0F)}, Splat{at, Rgb(1.0F)}}) {
        work.splats.push_back(splat);
      }
      return {};
    }
  };
  const std::string box = R"yaml(
film: {size: [24, 16], crop: [2, 1, 22, 15], filter: box}
sampling: {samples: 40, seed: 3}
objects: {ball: {shape: sphere}}
)yaml";
  const Rendering bad(std::make_unique<Bad>(), box);
  const RenderedUnit done = bad.renderer.render({1, {4, 4, 6, 6}, {0, 1}});
  EXPECT_EQ(done.counters.samples, 64U);
  EXPECT_EQ(done.counters.bad_samples, 4 * 64U);
  EXPECT_EQ(done.film.splats().count(), 1U);
  EXPECT_EQ(to_double(done.film.splats().at(8, 8).value[2]), 64.0);
  EXPECT_TRUE(done.film.check());
  PathLog log;
  bad.renderer.replay({4, 4}, 0, log);
  EXPECT_THAT(log.lines,
              testing::ElementsAre(
                  "splat 0 at 8.000, 8.000: 1 inf 1 for pixel 8, 8, which is not counted",
                  "splat 1 at 8.000, 8.000: nan nan nan for pixel 8, 8, which is not counted",
                  "splat 2 at 8.000, 8.000: 1e+17 1e+17 1e+17 for pixel 8, 8, which is not counted",
                  "splat 3 at nan, 1.000: it is not counted",
                  "splat 4 at 8.000, 8.000: 0 0 0 for pixel 8, 8",
                  "splat 5 at -100.000, 8.000: outside of what is rendered",
                  "splat 6 at 100.000, 8.000: outside of what is rendered",
                  "splat 7 at 8.000, 8.000: 1 1 1 for pixel 8, 8"));
}

TEST(Splatting, AStoppedUnitHasTheSplatsOfWholeBatches) {
  class Stopper final : public Integrator {
   public:
    explicit Stopper(std::atomic<bool>& stop) : stop_(stop) {}
    PixelSample sample(const Scene& /*scene*/, const Ray& /*ray*/, Sampler& /*sampler*/,
                       Workspace& work) const override {
      work.splats.push_back({{8.0F, 8.0F}, Rgb(1.0F)});
      if (++count_ == 100) stop_ = true;
      return {};
    }

   private:
    std::atomic<bool>& stop_;
    mutable std::atomic<int> count_ = 0;
  };
  std::atomic<bool> stop = false;
  const Rendering test(std::make_unique<Stopper>(stop));
  const RenderedUnit done = test.renderer.render({1, {4, 4, 6, 6}, {0, 2}}, &stop);
  EXPECT_TRUE(done.stopped);
  const RenderedUnit first = [] {
    std::atomic<bool> never = false;
    const Rendering again(std::make_unique<Stopper>(never));
    return again.renderer.render({1, {4, 4, 6, 6}, {0, 1}});
  }();
  EXPECT_EQ(done.film.digest(), first.film.digest());
}

}  // namespace
}  // namespace hyades::core
