#pragma once

#include <vector>

#include "core/base/bounds.h"
#include "core/job/job.h"

namespace hyades::core {

/// The matrix of a transform list followed by the translation `at`, at one moment. Steps apply top
/// to bottom.
Mat4 transform_at(const TransformList& steps, const Animated<Vec3>& at, const JobTime& time);

/// The bounds of `box`, none of it infinite, under `m`; empty ones stay empty.
Bounds transformed(const Mat4& m, const Bounds& box);

/// Samples of `matrix_of(JobTime)` over the shutter interval of `frame` at equal steps, as few as
/// keep linear interpolation between them within 1e-4 of the truth (relative to the matrix's size),
/// at most kShutterMoments. One where the shutter is closed or nothing moves.
template <class MatrixOf>
std::vector<Mat4> shutter_matrices(const Job& job, int32_t frame, const MatrixOf& matrix_of);

/// Largest difference of two matrices' elements.
float largest_difference(const Mat4& a, const Mat4& b);

template <class MatrixOf>
std::vector<Mat4> shutter_matrices(const Job& job, int32_t frame, const MatrixOf& matrix_of) {
  constexpr int kFine = kShutterMoments - 1;
  if (job.frames.shutter <= 0.0F) return {matrix_of(job.time_of(frame))};
  std::vector<Mat4> fine;
  for (int i = 0; i <= kFine; ++i) {
    fine.push_back(matrix_of(job.time_of(frame, static_cast<float>(i) / kFine)));
  }
  float size = 0.0F;
  float moved = 0.0F;
  for (const Mat4& m : fine) {
    size = std::max(size, largest_difference(m, Mat4(0.0F)));
    moved = std::max(moved, largest_difference(m, fine[0]));
  }
  if (moved == 0.0F) return {fine[0]};
  for (int stride = kFine; stride > 1; stride /= 2) {
    float error = 0.0F;
    for (int i = 0; i < kFine; ++i) {
      const int base = i / stride * stride;
      const float w = static_cast<float>(i - base) / static_cast<float>(stride);
      const Mat4 between = fine[static_cast<size_t>(base)] * (1.0F - w) +
                           fine[static_cast<size_t>(base + stride)] * w;
      error = std::max(error, largest_difference(between, fine[static_cast<size_t>(i)]));
    }
    if (error <= 1e-4F * size) {
      std::vector<Mat4> coarse;
      for (int i = 0; i <= kFine; i += stride) coarse.push_back(fine[static_cast<size_t>(i)]);
      return coarse;
    }
  }
  return fine;
}

}  // namespace hyades::core
