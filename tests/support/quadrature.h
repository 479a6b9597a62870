#pragma once

#include <functional>

#include "core/base/vec.h"

/// Integrals to compare estimators with: adaptive, deterministic, in double.
namespace hyades::test {

/// Integral of f over [a, b]: Gauss-Legendre of 7 points against two parts, split until they agree
/// to `tolerance` (absolute, of the whole) or `depth` times. The interval is first cut into
/// `pieces`, so that narrow peaks are not overlooked.
double integrate(const std::function<double(double)>& f, double a, double b,
                 double tolerance = 1e-8, int pieces = 8, int depth = 24);

/// Integral of f over [ax, bx] x [ay, by] in the same way (Gauss-Lobatto, 5 x 5 points, against
/// four parts); steps along curves are followed too.
double integrate2(const std::function<double(double, double)>& f, double ax, double bx, double ay,
                  double by, double tolerance = 1e-7, int pieces = 4, int depth = 10);

/// The unit direction of z = cos(theta) and azimuth phi.
core::Vec3 spherical(double z, double phi);

/// Integral of f over the directions with z in [z0, z1], per solid angle.
double integrate_sphere(const std::function<double(const core::Vec3&)>& f, double z0 = -1.0,
                        double z1 = 1.0, double tolerance = 1e-6, int pieces = 16, int depth = 10);

}  // namespace hyades::test
