#include "cli/display/shown_films.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coordinator/local/fake_render.h"
#include "tests/support/fake_viewer.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {
namespace {

coordinator::LocalPlan small_plan() {
  coordinator::LocalPlan plan;
  plan.frames = {3, 4};
  plan.region = {5, 7, 5 + 150, 7 + 75};
  plan.samples = 40;
  plan.threads = 2;
  plan.tile_size = 32;
  return plan;
}

/// Whether the viewer shows what the frame's whole film is, as a picture.
testing::AssertionResult shows_film(const test::FakeViewer& fake, const std::string& name,
                                    int32_t frame, const coordinator::LocalPlan& plan,
                                    bool splats) {
  const core::Image truth =
      coordinator::fake_film({frame, plan.region, {0, core::batch_count(plan.samples)}},
                             plan.samples, splats ? plan.region : core::PixelRect{})
          .normalised();
  const auto is_shown = [&](const test::FakeViewer::Seen& seen) {
    const auto found = seen.pictures.find(name);
    return found != seen.pictures.end() && found->second.channels == truth.channels &&
           found->second.values == truth.data;
  };
  if (fake.wait_until(is_shown, std::chrono::seconds(20))) return testing::AssertionSuccess();
  return testing::AssertionFailure() << name << " is not the film";
}

void run(const coordinator::LocalPlan& plan, bool splats, ShownFilms& shown,
         const coordinator::FilmStoreOptions& log = {}) {
  coordinator::FakeRender render(plan.samples);
  if (splats) render.splat_region = plan.region;
  coordinator::LocalRun run(plan, log, render, render, &shown);
  ASSERT_TRUE(run.start());
  ASSERT_TRUE(run.wait_for(std::chrono::seconds(60)));
}

TEST(ShownFilms, EveryFrameInTheEndIsItsFilm) {
  for (const bool splats : {false, true}) {
    SCOPED_TRACE(splats);
    test::FakeViewer fake;
    Viewer viewer(fake.address());
    ShownFilms shown(viewer, "walk", true);
    const coordinator::LocalPlan plan = small_plan();
    run(plan, splats, shown);
    EXPECT_TRUE(shows_film(fake, "walk.0003", 3, plan, splats));
    EXPECT_TRUE(shows_film(fake, "walk.0004", 4, plan, splats));
    EXPECT_THAT(fake.seen().wrong, testing::IsEmpty());
  }
}

TEST(ShownFilms, GrowingFilmsAreShownBeforeTheyAreComplete) {
  test::FakeViewer fake;
  Viewer viewer(fake.address());
  ShownFilms shown(viewer, "still", false);
  core::Film film(core::make_film_layout({.depth = true}), {0, 0, 64, 64});
  const core::Unit unit{1, {0, 0, 32, 32}, {0, 1}};
  ASSERT_TRUE(film.merge(coordinator::fake_film(unit, 16)));
  shown.grown(1, film, unit.tile);
  EXPECT_TRUE(fake.wait_until([&](const auto& seen) {
    const auto found = seen.pictures.find("still");
    return found != seen.pictures.end() && found->second.values == film.normalised().data;
  }));
}

TEST(ShownFilms, WhatAnEarlierRunLeftIsShownToo) {
  const test::TempFolder folder;
  test::FakeViewer fake;
  Viewer viewer(fake.address());
  ShownFilms shown(viewer, "walk", true);
  coordinator::LocalPlan plan = small_plan();
  plan.frames = {3};
  coordinator::FilmStoreOptions log;
  log.folder = folder.file("log");
  {
    coordinator::FakeRender render(plan.samples);
    coordinator::LocalRun first(plan, log, render, render);
    ASSERT_TRUE(first.start());
    while (first.progress().units_done < 4 && !first.wait_for(std::chrono::milliseconds(1))) {
    }
    first.stop();
    ASSERT_TRUE(first.wait_for(std::chrono::seconds(60)));
  }
  log.kept = coordinator::KeptFilms::require;
  run(plan, false, shown, log);
  EXPECT_TRUE(shows_film(fake, "walk.0003", 3, plan, false));
}

}  // namespace
}  // namespace hyades::cli
