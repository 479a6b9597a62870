#pragma once

#include <array>
#include <vector>

#include "tests/truth/render_yaml.h"

namespace hyades::test {

/// Means of a picture and of its square blocks over independent renderings of it: honest variances
/// also where pixels are correlated (splats of one light path, mutations of one chain).
struct Replicates {
  std::array<Moments, 3> picture;              ///< by channel
  std::vector<std::array<Moments, 3>> blocks;  ///< row by row
  std::vector<std::array<Moments, 3>> pixels;  ///< row by row
  uint64_t bad_samples = 0;
};

/// Renders the job of `scene` `runs` times with different seeds; `block` pixels make a block's
/// side.
Replicates render_replicates(const YamlScene& scene, int runs, int block);

/// Renders the job `runs` times with different seeds, and with other settings of the integrator
/// than the job's; `block` pixels make a block's side.
Replicates render_replicates(const YamlScene& scene, const core::IntegratorDesc& integrator,
                             int runs, int block);

/// Whether the mean of `runs` renderings with different seeds is `expected`, by the spread between
/// them: for Metropolis, whose pixels are correlated.
void expect_mean_of_runs(const YamlScene& scene, int runs, const core::Vec3d& expected,
                         const Promise& promise);

/// Whether two estimates of one picture agree: the picture's mean in the sense of `promise` (its
/// tests are the channels of all comparisons), and all blocks together (Sidak).
void expect_same_picture(const Replicates& a, const Replicates& b, const Promise& promise);

/// Whether two estimates of one picture agree pixel by pixel, as Mitsuba's test_renders.py has it:
/// 99.75 % of the values pass a test at a significance of 0.01 shared among them (Sidak). Notices
/// an error of `relative_error` of the picture's mean in one value of a hundred, if these are
/// among the nine of ten with the least noise, or fails as underpowered.
void expect_same_pixels(const Replicates& a, const Replicates& b, double relative_error);

}  // namespace hyades::test
