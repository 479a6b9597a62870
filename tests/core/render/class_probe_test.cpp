#include "core/render/class_probe.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "core/job/parse.h"
#include "core/render/probe_scene.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::core {
namespace {

TEST(ClassProbe, FilmIsTheSameWithAnyThreadsAndAgain) {
  const auto film = render_class_probe(1);
  ASSERT_TRUE(film.ok()) << film.error().message;
  for (const int threads : {1, 2, 5}) {
    const auto again = render_class_probe(threads);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->digest(), film->digest()) << threads << " threads";
  }
}

TEST(ClassProbe, ClassIsMeasuredAlikeEveryTime) {
  const auto probe = probe_class();
  ASSERT_TRUE(probe.ok()) << probe.error().message;
  EXPECT_EQ(class_of(*probe), *this_class());
  EXPECT_EQ(class_of(*probe).size(), 64U);
}

TEST(ClassProbe, EveryPartDecides) {
  const ClassProbe probe = *probe_class();
  std::set<std::string> classes{class_of(probe)};
  for (std::string ClassProbe::*part :
       {&ClassProbe::film, &ClassProbe::elementary, &ClassProbe::reciprocals, &ClassProbe::build,
        &ClassProbe::embree}) {
    EXPECT_FALSE((probe.*part).empty());
    ClassProbe other = probe;
    (other.*part).back() ^= 1;
    classes.insert(class_of(other));
  }
  EXPECT_EQ(classes.size(), 6U);
}

TEST(ClassProbe, OneBitOfTheFilmDecides) {
  Film film = *render_class_probe();
  const std::string before = film.digest();
  Fixed128& sum = film.mutable_plane(1)[film.plane(1).size() / 2];
  sum.low ^= 1;
  EXPECT_NE(film.digest(), before);
  sum.low ^= 1;
  EXPECT_EQ(film.digest(), before);
}

TEST(ClassProbe, TracesEnoughAndEverythingIsSeen) {
  const auto assets = make_probe_assets();
  Diagnostics diagnostics;
  const Job job = parse_job(kProbeJob, "probe", *assets, diagnostics);
  ASSERT_TRUE(diagnostics.empty()) << diagnostics.to_string();
  SceneCache cache(*assets);
  const auto scene = build_scene(job, job.frames.first, cache);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const FrameRenderer renderer(*scene, job, 1, {});
  const RenderedFrame frame =
      render_frame(renderer, render_window(job.film), job.sampling.samples, 1);
  RecordProperty("rays", static_cast<int>(frame.counters.rays));
  EXPECT_GT(frame.counters.rays, 80'000U);
  EXPECT_LT(frame.counters.rays, 300'000U);
  EXPECT_EQ(frame.counters.bad_samples, 0U);
}

}  // namespace
}  // namespace hyades::core
