// The gallery, small, by two estimators: path tracing and bidirectional path tracing give the same
// picture. Left out: what `hyades render` imports first (lamplighter, and the scenes in Lua:
// creature, rings, sphere-and-planes, town); cloudscape and atlas, where even 20 % would take
// minutes.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <regex>
#include <sstream>
#include <string>

#include "tests/support/test_quarter.h"
#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

struct GalleryJob {
  const char* name;
  int path_samples;
  int bdpt_samples;
  int max_depth;
  double relative_error;  ///< of the picture's mean that is noticed with 99 % probability
};

void PrintTo(const GalleryJob& job, std::ostream* out) { *out << job.name; }

constexpr int kRuns = 12;

const GalleryJob kJobs[] = {
    {"quickstart", 320, 144, 10, 0.1},
    {"cornell", 128, 64, 10, 0.05},
    {"color-bleeding", 160, 80, 10, 0.015},
    {"soft-shadows", 576, 288, 6, 0.2},
    {"depth-of-field", 512, 320, 10, 0.15},
    {"antialiasing", 64, 32, 10, 0.025},
    {"perlin-sphere", 256, 128, 10, 0.1},
    {"mesh-100k", 128, 64, 10, 0.015},
    {"glass-caustics", 2400, 600, 10, 0.06},
    {"gloss", 128, 64, 10, 0.06},
    {"textured", 64, 32, 10, 0.1},
    {"textured-gloss", 320, 160, 10, 0.12},
    {"leaves", 96, 48, 10, 0.03},
    {"island", 64, 32, 8, 0.015},
    {"lanterns", 64, 32, 6, 0.1},
    {"panorama", 192, 96, 6, 0.1},
    {"stained-glass", 640, 320, 8, 0.15},
    {"metropolis", 800, 400, 8, 0.12},
    {"materials", 480, 240, 64, 0.1},
    {"media", 64, 32, 64, 0.1},
    {"god-rays", 224, 112, 10, 0.1},
    // Of the low sun that the water mirrors, deep paths are rare and bright.
    {"cloud", 320, 160, 12, 0.15},
    {"sky-shell", 320, 160, 10, 0.1}};

YamlScene small(const GalleryJob& job, const std::string& integrator, int samples) {
  const std::string folder = std::string("jobs/") + job.name;
  std::ifstream file(folder + "/job.yaml");
  std::stringstream whole;
  whole << file.rdbuf();
  std::string text = whole.str();
  // In the job's own words, or over those that it includes.
  const auto set = [&](const std::string& key, const std::string& value) {
    const std::regex line("\n" + key + ": [^\n]*");
    const std::string mine = "\n" + key + ": " + value;
    text =
        std::regex_search(text, line) ? std::regex_replace(text, line, mine) : text + mine + "\n";
  };
  set("film", "{size: [24, 14], filter: {type: gaussian, radius: 1}}");
  set("sampling", "{samples: " + std::to_string(samples) + "}");
  set("integrator", "{type: " + integrator + ", max_depth: " + std::to_string(job.max_depth) + "}");
  return YamlScene(text, 1, {}, folder);
}

class Gallery : public testing::TestWithParam<GalleryJob> {};

TEST_P(Gallery, IsTheSameByPathAndBdpt) {
  const GalleryJob& job = GetParam();
  if (!in_quarter(kJobs, job.name)) GTEST_SKIP() << kOtherQuarter;
  const Promise promise{.significance = 0.01,
                        .tests = 3 * static_cast<int>(std::size(kJobs)),
                        .relative_error = job.relative_error,
                        .power = 0.99};
  const Replicates path = render_replicates(small(job, "path", job.path_samples), kRuns, 7);
  const Replicates bdpt = render_replicates(small(job, "bdpt", job.bdpt_samples), kRuns, 7);
  expect_same_picture(path, bdpt, promise);
}

INSTANTIATE_TEST_SUITE_P(Jobs, Gallery, testing::ValuesIn(kJobs), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace hyades::test
