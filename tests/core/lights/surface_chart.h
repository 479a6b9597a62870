#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/shape.h"

/// Coordinates on shapes, written down here once more so that tests do not take them from the code
/// that they test.
namespace hyades::test {

/// A place on a shape: `u` and `v` in [0, 1) on one of its patches (the faces of a box).
struct ChartPlace {
  int patch = 0;
  double u = 0.0;
  double v = 0.0;
};

/// A map of a shape's surface, in object space.
class SurfaceChart {
 public:
  virtual ~SurfaceChart() = default;
  virtual int patches() const { return 1; }
  virtual core::Vec3d position(const ChartPlace& place) const = 0;
  virtual core::Vec3d normal(const ChartPlace& place) const = 0;  ///< unit, outward
  virtual ChartPlace find(const core::Vec3d& position) const = 0;

 protected:
  static double turn(double x, double z) {
    const double t = std::atan2(z, x) / (2.0 * M_PI);
    return t < 0.0 ? t + 1.0 : t;
  }
};

class SphereChart : public SurfaceChart {
 public:
  explicit SphereChart(double radius) : radius_(radius) {}
  core::Vec3d position(const ChartPlace& p) const override { return radius_ * normal(p); }
  core::Vec3d normal(const ChartPlace& p) const override {
    const double y = 2.0 * p.v - 1.0;
    const double r = std::sqrt(std::max((1.0 - y) * (1.0 + y), 0.0));
    return {r * std::cos(2.0 * M_PI * p.u), y, r * std::sin(2.0 * M_PI * p.u)};
  }
  ChartPlace find(const core::Vec3d& x) const override {
    return {0, turn(x.x, x.z), 0.5 * (x.y / radius_ + 1.0)};
  }

 private:
  double radius_;
};

class DiskChart : public SurfaceChart {
 public:
  explicit DiskChart(double radius) : radius_(radius) {}
  core::Vec3d position(const ChartPlace& p) const override {
    const double r = radius_ * std::sqrt(p.v);
    return {r * std::cos(2.0 * M_PI * p.u), 0.0, r * std::sin(2.0 * M_PI * p.u)};
  }
  core::Vec3d normal(const ChartPlace& /*place*/) const override { return {0.0, 1.0, 0.0}; }
  ChartPlace find(const core::Vec3d& x) const override {
    return {0, turn(x.x, x.z), (x.x * x.x + x.z * x.z) / (radius_ * radius_)};
  }

 private:
  double radius_;
};

class CylinderChart : public SurfaceChart {
 public:
  CylinderChart(double radius, double height) : radius_(radius), height_(height) {}
  core::Vec3d position(const ChartPlace& p) const override {
    return radius_ * normal(p) + core::Vec3d(0.0, height_ * p.v, 0.0);
  }
  core::Vec3d normal(const ChartPlace& p) const override {
    return {std::cos(2.0 * M_PI * p.u), 0.0, std::sin(2.0 * M_PI * p.u)};
  }
  ChartPlace find(const core::Vec3d& x) const override {
    return {0, turn(x.x, x.z), x.y / height_};
  }

 private:
  double radius_;
  double height_;
};

/// A box around the origin; a rectangle where the size along y is 0 (one patch, facing +y).
class BoxChart : public SurfaceChart {
 public:
  explicit BoxChart(const core::Vec3d& size) : half_(0.5 * size) {}
  int patches() const override { return half_.y == 0.0 ? 1 : 6; }
  core::Vec3d position(const ChartPlace& p) const override {
    const int axis = axis_of(p.patch);
    core::Vec3d x;
    x[axis] = side_of(p.patch) * half_[axis];
    x[(axis + 1) % 3] = (2.0 * p.u - 1.0) * half_[(axis + 1) % 3];
    x[(axis + 2) % 3] = (2.0 * p.v - 1.0) * half_[(axis + 2) % 3];
    return x;
  }
  core::Vec3d normal(const ChartPlace& p) const override {
    core::Vec3d n(0.0);
    n[axis_of(p.patch)] = side_of(p.patch);
    return n;
  }
  ChartPlace find(const core::Vec3d& x) const override {
    int best = 0;
    for (int patch = 1; patch < patches(); ++patch) {
      if (gap(x, patch) < gap(x, best)) best = patch;
    }
    const int axis = axis_of(best);
    return {best, 0.5 * (x[(axis + 1) % 3] / half_[(axis + 1) % 3] + 1.0),
            0.5 * (x[(axis + 2) % 3] / half_[(axis + 2) % 3] + 1.0)};
  }

 private:
  static int axis_of(int patch) { return (patch + 1) % 3; }  // patch 0 is +y
  static double side_of(int patch) { return patch < 3 ? 1.0 : -1.0; }
  double gap(const core::Vec3d& x, int patch) const {
    return std::abs(x[axis_of(patch)] - side_of(patch) * half_[axis_of(patch)]);
  }

  core::Vec3d half_;
};

}  // namespace hyades::test
