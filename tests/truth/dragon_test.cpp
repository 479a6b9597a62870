// The main job on real input: a scanned mesh in glass and in gold under a measured sky.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

TEST(Dragons, RenderInGlassAndGoldUnderAMeasuredSky) {
  if (shared_folder().empty()) GTEST_SKIP() << "needs ../shared/assets, which is not here";
  std::ifstream file("tests/jobs/dragons.yaml");
  std::stringstream text;
  text << file.rdbuf();
  std::string yaml = with_shared_folder(text.str());
  yaml.replace(yaml.find("samples: 256"), 12, "samples: 16");
  const YamlScene scene(yaml, 1, {.depth = true}, "tests/jobs");
  EXPECT_GE(scene.renderer().scene().triangles, 200'024U);
  const core::PixelRect middle{240, 120, 720, 420};
  const auto frame = core::render_frame(scene.renderer(), middle, 16, 1, {.threads = 2});
  EXPECT_EQ(frame.counters.bad_samples, 0U);
  const core::Image picture = frame.film.normalised();
  // Gold is yellow: where the gold dragon's back is, red outweighs blue by far; depth finds both
  // dragons.
  int near = 0;
  int golden = 0;
  const int depth = picture.find_channel("depth.Z");
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (picture.at(x, y, depth) < 0.6F) ++near;
      if (picture.at(x, y, 0) > 1.8F * picture.at(x, y, 2)) ++golden;
    }
  }
  EXPECT_GT(near, 20'000);
  EXPECT_GT(golden, 3'000);
}

}  // namespace
}  // namespace hyades::test
