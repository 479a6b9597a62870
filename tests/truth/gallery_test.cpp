// The gallery, small and with few events, by two estimators: path tracing and bidirectional path
// tracing give the same picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <regex>
#include <sstream>
#include <string>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

struct GalleryJob {
  const char* name;
  int path_samples;
  int bdpt_samples;
  double relative_error;  ///< of the picture's mean that is noticed with 99 % probability
};

void PrintTo(const GalleryJob& job, std::ostream* out) { *out << job.name; }

constexpr int kRuns = 12;

const GalleryJob kJobs[] = {{"quickstart", 320, 144, 0.1},
                            {"cornell", 128, 64, 0.05},
                            {"depth-of-field", 512, 320, 0.15},
                            {"antialiasing", 64, 32, 0.05},
                            {"perlin-sphere", 192, 112, 0.1},
                            {"mesh-100k", 64, 32, 0.05},
                            {"glass-caustics", 640, 64, 0.12},
                            {"god-rays", 176, 88, 0.1},
                            {"cloud", 64, 32, 0.1},
                            {"sky-shell", 48, 20, 0.1},
                            {"media", 64, 32, 0.1}};

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
  set("integrator", "{type: " + integrator + ", max_depth: 6}");
  return YamlScene(text, 1, {}, folder);
}

class Gallery : public testing::TestWithParam<GalleryJob> {};

TEST_P(Gallery, IsTheSameByPathAndBdpt) {
  const GalleryJob& job = GetParam();
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
