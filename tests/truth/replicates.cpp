#include "tests/truth/replicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace hyades::test {

Replicates render_replicates(const YamlScene& scene, int runs, int block) {
  return render_replicates(scene, scene.job().integrator, runs, block);
}

Replicates render_replicates(const YamlScene& scene, const core::IntegratorDesc& integrator,
                             int runs, int block) {
  Replicates result;
  // The scene outlives its renderers.
  const std::shared_ptr<const core::Scene> shared(std::shared_ptr<void>(),
                                                  &scene.renderer().scene());
  core::Job job = scene.job();
  job.integrator = integrator;
  for (int run = 0; run < runs; ++run) {
    job.sampling.seed = scene.job().sampling.seed + static_cast<uint64_t>(run);
    const core::FrameRenderer renderer(shared, job, 1, scene.renderer().layout().layers);
    const core::RenderedFrame frame = core::render_frame(renderer, core::render_window(job.film),
                                                         job.sampling.samples, 1, {.threads = 2});
    result.bad_samples += frame.counters.bad_samples;
    const core::Image picture = frame.film.normalised();
    const int columns = (picture.width + block - 1) / block;
    const int rows = (picture.height + block - 1) / block;
    result.blocks.resize(static_cast<size_t>(columns * rows));
    result.pixels.resize(static_cast<size_t>(picture.width * picture.height));
    std::vector<std::array<double, 3>> sums(result.blocks.size());
    std::vector<double> counts(result.blocks.size());
    std::array<double, 3> total{};
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const auto i = static_cast<size_t>(y / block * columns + x / block);
        counts[i] += 1.0;
        for (int c = 0; c < 3; ++c) {
          const auto channel = static_cast<size_t>(c);
          const auto value = static_cast<double>(picture.at(x, y, c));
          sums[i][channel] += value;
          total[channel] += value;
          result.pixels[static_cast<size_t>(y * picture.width + x)][channel].add(value);
        }
      }
    }
    for (size_t c = 0; c < 3; ++c) {
      result.picture[c].add(total[c] / (picture.width * picture.height));
      for (size_t i = 0; i < sums.size(); ++i) result.blocks[i][c].add(sums[i][c] / counts[i]);
    }
  }
  return result;
}

void expect_mean_of_runs(const YamlScene& scene, int runs, const core::Vec3d& expected,
                         const Promise& promise) {
  const Replicates found = render_replicates(scene, runs, scene.job().film.width);
  EXPECT_EQ(found.bad_samples, 0U);
  for (int c = 0; c < 3; ++c) {
    EXPECT_TRUE(mean_is(found.picture[static_cast<size_t>(c)], expected[c], promise))
        << "channel " << c;
  }
}

void expect_same_picture(const Replicates& a, const Replicates& b, const Promise& promise) {
  EXPECT_EQ(a.bad_samples + b.bad_samples, 0U);
  const Promise each{promise.significance / 2.0, promise.tests, promise.relative_error,
                     promise.power};
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(means_agree(a.picture[c], b.picture[c], each)) << "channel " << c;
  }
  double least = 1.0;
  size_t worst = 0;
  for (size_t i = 0; i < a.blocks.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double p = t_test(a.blocks[i][c], b.blocks[i][c]);
      if (p >= least) continue;
      least = p;
      worst = 3 * i + c;
    }
  }
  const double alpha = sidak(each.significance, static_cast<int>(a.blocks.size()) * each.tests);
  const Moments& of_a = a.blocks[worst / 3][worst % 3];
  const Moments& of_b = b.blocks[worst / 3][worst % 3];
  EXPECT_GE(least, alpha) << "block " << worst / 3 << " channel " << worst % 3 << ": "
                          << of_a.mean() << " and " << of_b.mean();
}

void expect_same_pixels(const Replicates& a, const Replicates& b, double relative_error) {
  const size_t values = 3 * a.pixels.size();
  const double alpha = sidak(0.01, static_cast<int>(values));
  std::vector<double> noticed;  // by the test of each value, relative to the picture's mean
  size_t failed = 0;
  std::string told;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const Moments& of_a = a.pixels[i][c];
      const Moments& of_b = b.pixels[i][c];
      const double variance = of_a.variance_of_mean() + of_b.variance_of_mean();
      noticed.push_back(detectable_effect(variance, alpha, 0.99) / a.picture[c].mean());
      if (t_test(of_a, of_b) >= alpha) continue;
      if (++failed <= 5) {
        told += "\n  pixel " + std::to_string(i) + " channel " + std::to_string(c) + ": " +
                std::to_string(of_a.mean()) + " and " + std::to_string(of_b.mean());
      }
    }
  }
  EXPECT_LE(static_cast<double>(failed), 0.0025 * static_cast<double>(values)) << told;
  std::sort(noticed.begin(), noticed.end());
  EXPECT_LE(noticed[noticed.size() * 9 / 10], relative_error) << "underpowered";
}

}  // namespace hyades::test
