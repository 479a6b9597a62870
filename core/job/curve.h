#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/job/animated.h"

namespace hyades::core {

struct Job;

/// A value that a job says, and that may change over its frames.
struct Curve {
  std::string path;  ///< "camera.fov", "objects.ball.at", "objects.ball.transform[1].rotate_y"
  std::variant<Animated<float>, Animated<Vec2>, Animated<Vec3>, Animated<Vec4>> value;

  /// The one to four numbers of the value at `time`.
  std::vector<float> at(const JobTime& time) const;
  bool is_constant() const;
};

/// The curve at `path`; an error that lists what there is instead. Values that the job does not
/// write are no curves.
Result<const Curve*> find_curve(const Job& job, const std::string& path);

/// What `hyades check --curve` prints: a little picture of each number over the frames, then a
/// table of frames and values.
std::string curve_table(const Job& job, const Curve& curve);

}  // namespace hyades::core
