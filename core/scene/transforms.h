#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/bounds.h"
#include "core/job/job.h"

namespace hyades::core {

/// The matrix of a transform list followed by the translation `at`, at one moment. Steps apply top
/// to bottom.
Mat4 transform_at(const TransformList& steps, const Animated<Vec3>& at, const JobTime& time);

/// Whether any step says something else at some other time.
bool is_animated(const TransformList& steps);

/// The bounds of `box`, none of it infinite, under `m`; empty ones stay empty.
Bounds transformed(const Mat4& m, const Bounds& box);

/// The matrix at a place of the open shutter, 0..1.
using ShutterMatrix = std::function<Mat4(float)>;

/// Samples of `matrix_at` at equal steps, as few of 1, 2, 4, ... 128 as keep what is linear between
/// them within 1e-4 of the truth: the linear part relative to its largest element, so that a point
/// at distance r from where a rotation begins is out by 1e-4 r; the translation relative to that,
/// or to how far it moves. Between two matrices of a rotation points move on chords: by 1 - cos(a /
/// 2) of the radius inside of the arc for an angle `a` of a step, so 1e-4 takes steps of up to 1.6
/// degrees. That is kept up to 207 degrees; a whole turn in 128 steps is out by 3e-4, n turns by
/// n^2 times that. One matrix where nothing moves.
std::vector<Mat4> sampled_matrices(const ShutterMatrix& matrix_at);

/// sampled_matrices() of `matrix_of(JobTime)` over the shutter interval of `frame`. One where the
/// shutter is closed.
template <class MatrixOf>
std::vector<Mat4> shutter_matrices(const Job& job, int32_t frame, const MatrixOf& matrix_of);

template <class MatrixOf>
std::vector<Mat4> shutter_matrices(const Job& job, int32_t frame, const MatrixOf& matrix_of) {
  if (job.frames.shutter <= 0.0F) return {matrix_of(job.time_of(frame))};
  return sampled_matrices([&](float place) { return matrix_of(job.time_of(frame, place)); });
}

}  // namespace hyades::core
