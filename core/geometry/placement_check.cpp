#include "core/geometry/placement_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/placed_object.h"

namespace hyades::core {
namespace {

/// Embree's limit for the matrices of one motion (RTC_MAX_TIME_STEP_COUNT).
constexpr size_t kMaxSteps = 129;

/// Largest factor by which an instance may enlarge a ray: keeps kRayReach below 1.8e18.
constexpr double kLargestEnlargement = 1e5;

bool all_finite(const Mat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

bool is_positive(float x) { return x > 0.0F && std::isfinite(x); }

Status check_shape(const Shape& shape) {
  if (shape.kind == Shape::Kind::mesh) {
    if (shape.mesh == nullptr) return Error{"it has no mesh"};
    if (shape.deforms() && (shape.mesh->positions.size() != shape.next->positions.size() ||
                            shape.mesh->normals.empty() != shape.next->normals.empty())) {
      return Error{"the mesh that it deforms to has other vertices"};
    }
    if (shape.deforms() && !(shape.reach > 0.0F && shape.reach <= 1.0F)) {
      return Error{"its reach must be above 0 and at most 1"};
    }
    return {};
  }
  if (shape.kind == Shape::Kind::curves) {
    return shape.curves == nullptr ? Status(Error{"it has no curves"}) : Status();
  }
  if (!is_positive(shape.radius)) return Error{"its radius must be positive and finite"};
  if (shape.kind == Shape::Kind::cylinder && !is_positive(shape.height)) {
    return Error{"its height must be positive and finite"};
  }
  return {};
}

Status check_matrices(const std::vector<Mat4>& matrices) {
  if (matrices.empty()) return Error{"it has no transform"};
  if (matrices.size() > kMaxSteps) {
    return Error{"it has " + std::to_string(matrices.size()) + " motion steps; at most " +
                 std::to_string(kMaxSteps) + " are possible"};
  }
  if (!std::all_of(matrices.begin(), matrices.end(), all_finite)) {
    return Error{"its transform is not finite"};
  }
  return {};
}

/// Least absolute value of a cubic polynomial over [0, 1], given its values at 0, 1/3, 2/3, 1.
double least_of_cubic(const std::array<double, 4>& y) {
  // Its coefficients by Newton's divided differences with step 1/3.
  const double d1 = y[1] - y[0];
  const double d2 = y[2] - 2.0 * y[1] + y[0];
  const double d3 = y[3] - 3.0 * y[2] + 3.0 * y[1] - y[0];
  const double c1 = 3.0 * d1 - 1.5 * d2 + d3;
  const double c2 = 4.5 * (d2 - d3);
  const double c3 = 4.5 * d3;
  const auto value = [&](double t) { return y[0] + t * (c1 + t * (c2 + t * c3)); };
  std::array<double, 4> at{0.0, 1.0, 0.0, 1.0};
  const double root2 = c2 * c2 - 3.0 * c1 * c3;
  if (root2 >= 0.0) {
    // Where the derivative c1 + 2 c2 t + 3 c3 t^2 vanishes, without cancellation.
    const double q = -(c2 + (c2 >= 0.0 ? std::sqrt(root2) : -std::sqrt(root2)));
    if (c3 != 0.0) at[2] = std::clamp(q / (3.0 * c3), 0.0, 1.0);
    if (q != 0.0) at[3] = std::clamp(c1 / q, 0.0, 1.0);
  }
  double least = std::abs(value(at[0]));
  for (const double t : at) {
    if (value(t) * y[0] <= 0.0) return 0.0;
    least = std::min(least, std::abs(value(t)));
  }
  return least;
}

/// An upper bound of the norm of the inverse of any matrix between two: that of the adjugate (from
/// the lengths of the columns, convex in between) over the least determinant.
double inverse_bound(const Affine& a, const Affine& b) {
  std::array<double, 4> determinants;
  for (int i = 0; i < 4; ++i) {
    const double f = i / 3.0;
    determinants[static_cast<size_t>(i)] = glm::determinant(a.linear * (1.0 - f) + b.linear * f);
  }
  std::array<double, 3> columns2;
  for (int i = 0; i < 3; ++i) {
    columns2[static_cast<size_t>(i)] =
        std::max(glm::dot(a.linear[i], a.linear[i]), glm::dot(b.linear[i], b.linear[i]));
  }
  const auto [x, y, z] = columns2;
  const double adjugate = std::sqrt(x * y + y * z + z * x);
  const double least = least_of_cubic(determinants);
  return least > 0.0 ? adjugate / least : std::numeric_limits<double>::infinity();
}

float largest_coordinate(const Vec3& v) { return max_component(glm::abs(v)); }

bool in_reach(const Bounds& b) {
  return largest_coordinate(b.lower) <= kLargestCoordinate &&
         largest_coordinate(b.upper) <= kLargestCoordinate;
}

/// Of a member of an instancer, in all of its copies.
Status check_instancer(const Placement& p, const Bounds& box) {
  const PointInstancer& instancer = *p.instancer;
  if (instancer.places == nullptr || instancer.places->empty())
    return Error{"its instancer has no places"};
  if (Status s = check_matrices(instancer.to_world); !s) return s;
  Bounds inner;
  for (const Mat4& m : p.to_world) inner.include(transform_bounds(Affine(m), box));
  if (!box.empty() && !in_reach(inner)) return Error{"it reaches beyond a distance of 1e12 m"};
  const auto complain = [&](size_t copy, const char* what) {
    return Error{"copy " + std::to_string(copy) + " of " + instancer.name + " " + what};
  };
  for (size_t i = 0; i < instancer.places->size(); ++i) {
    const Mat4 place = place_matrix((*instancer.places)[i]);
    if (!all_finite(place)) return complain(i, "stands nowhere: its matrix is not finite");
    Placement copy;
    for (const Mat4& m : instancer.to_world) copy.to_world.push_back(m * place);
    copy.to_world.erase(copy.to_world.begin());
    if (!can_be_instanced(copy)) {
      return complain(i,
                      "is flat, or smaller than a hundred-thousandth: expected a matrix that has "
                      "an inverse");
    }
    for (const Mat4& m : copy.to_world) {
      if (!box.empty() && !in_reach(transform_bounds(Affine(m), inner))) {
        return complain(i, "reaches beyond a distance of 1e12 m");
      }
    }
  }
  return {};
}

}  // namespace

Status check_placement(const Placement& p) {
  if (Status s = check_shape(p.shape); !s) return s;
  if (Status s = check_matrices(p.to_world); !s) return s;
  const Bounds box = bounds_of(p.shape);
  if (p.shape.kind == Shape::Kind::curves && !can_be_instanced(p)) {
    return Error{"its transform makes it flat, or smaller than a hundred-thousandth"};
  }
  if (p.instancer != nullptr) return check_instancer(p, box);
  if (box.empty()) return {};
  for (const Mat4& m : p.to_world) {
    const Bounds b = transform_bounds(Affine(m), box);
    if (!in_reach(b)) {
      return Error{"it reaches beyond a distance of 1e12 m"};
    }
  }
  return {};
}

bool can_be_instanced(const Placement& p) {
  const Motion motion(p.to_world);
  const std::vector<Affine>& steps = motion.steps();
  for (size_t i = 0; i < steps.size(); ++i) {
    if (!(largest_coordinate(Vec3(steps[i].offset)) <= kLargestCoordinate)) return false;
    const Affine& next = steps[std::min(i + 1, steps.size() - 1)];
    if (!(inverse_bound(steps[i], next) <= kLargestEnlargement)) return false;
  }
  return true;
}

bool can_be_instanced(const Mat4& to_world) {
  const Affine map(to_world);
  return largest_coordinate(Vec3(map.offset)) <= kLargestCoordinate &&
         inverse_bound(map, map) <= kLargestEnlargement;
}

std::string describe_placement(const Placement& p, size_t number) {
  std::string text = "object " + std::to_string(number);
  if (p.shape.kind == Shape::Kind::mesh && p.shape.mesh != nullptr) {
    text += " (" + p.shape.mesh->name + ")";
  }
  if (p.shape.curves != nullptr) text += " (" + p.shape.curves->name + ")";
  return text;
}

}  // namespace hyades::core
