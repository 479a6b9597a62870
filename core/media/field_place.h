#pragma once

#include <vector>

#include "core/base/ray.h"
#include "core/base/vec.h"

namespace hyades::core {

/// A ray in the space of a field, where t stays the same: a distance in the world.
struct FieldRay {
  Vec3 origin;
  Vec3 direction;
  Vec3 at(float t) const { return origin + t * direction; }
};

/// Where a field's space is in the world while the shutter is open.
class FieldPlace {
 public:
  /// Field to world at equal steps over the shutter interval, at least one, interpolated linearly
  /// between neighbours as a body's own matrices are. What is squeezed flat is nowhere.
  explicit FieldPlace(std::vector<Mat4> to_world);

  /// World to field at shutter time `time`, 0 to 1.
  Mat4 to_field(float time) const { return to_world_.size() == 1 ? to_field_ : moving(time); }

  FieldRay in_field(const Ray& ray) const {
    const Mat4 m = to_field(ray.time);
    return {transform_point(m, ray.origin), transform_vector(m, ray.direction)};
  }

 private:
  Mat4 moving(float time) const;

  std::vector<Mat4> to_world_;
  Mat4 to_field_;  ///< when the shutter opens
};

}  // namespace hyades::core
