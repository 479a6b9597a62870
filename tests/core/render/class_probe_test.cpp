#include "core/render/class_probe.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "core/job/parse.h"
#include "core/render/probe_scene.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::core {
namespace {

class ClassProbes : public ::testing::TestWithParam<RenderClass> {};

TEST_P(ClassProbes, FilmIsTheSameWithAnyThreadsAndAgain) {
  const auto film = render_class_probe(GetParam(), 1);
  ASSERT_TRUE(film.ok()) << film.error().message;
  for (const int threads : {1, 2, 5}) {
    const auto again = render_class_probe(GetParam(), threads);
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->digest(), film->digest()) << threads << " threads";
  }
}

TEST_P(ClassProbes, AreMeasuredAlikeEveryTime) {
  const auto probe = probe_class(GetParam());
  ASSERT_TRUE(probe.ok()) << probe.error().message;
  EXPECT_EQ(class_of(*probe), *this_class(GetParam()));
  EXPECT_EQ(class_of(*probe).size(), 64U);
}

TEST_P(ClassProbes, EveryPartDecides) {
  const ClassProbe probe = *probe_class(GetParam());
  std::set<std::string> classes{class_of(probe)};
  std::vector<std::string ClassProbe::*> parts = {&ClassProbe::film, &ClassProbe::elementary,
                                                  &ClassProbe::build};
  if (GetParam() == RenderClass::native) {
    parts.insert(parts.end(), {&ClassProbe::reciprocals, &ClassProbe::embree});
  } else {
    // What differs between processors and compilers.
    EXPECT_EQ(probe.reciprocals + probe.embree, "");
    EXPECT_NE(probe.build, build_id());
  }
  for (std::string ClassProbe::*part : parts) {
    EXPECT_FALSE((probe.*part).empty());
    ClassProbe other = probe;
    (other.*part).back() ^= 1;
    classes.insert(class_of(other));
  }
  EXPECT_EQ(classes.size(), parts.size() + 1);
}

INSTANTIATE_TEST_SUITE_P(Both, ClassProbes,
                         ::testing::Values(RenderClass::native, RenderClass::portable),
                         [](const auto& tested) {
                           return kRenderClassNames[static_cast<size_t>(tested.param)];
                         });

TEST(ClassProbe, ClassesOfOneMachineDiffer) {
  EXPECT_NE(*this_class(RenderClass::native), *this_class(RenderClass::portable));
}

// The film that the portable class is known by. Other compilers and processors must give the same;
// whoever changes what is rendered writes the new one here.
TEST(ClassProbe, PortableFilmIsTheSameEverywhere) {
  EXPECT_EQ(render_class_probe(RenderClass::portable)->digest(),
            "f866775d2150bb6c78a9da7f05fc75451762c525bde3a06c5697b76f653ad373");
}

TEST(ClassProbe, OneBitOfTheFilmDecides) {
  Film film = *render_class_probe(RenderClass::native);
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
