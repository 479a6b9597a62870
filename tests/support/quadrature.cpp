#include "tests/support/quadrature.h"

#include <array>
#include <cmath>

namespace hyades::test {
namespace {

struct Node {
  double x;
  double weight;
};

/// Gauss-Legendre on [-1, 1] (Abramowitz and Stegun, table 25.4).
constexpr std::array<Node, 7> kSeven = {{{-0.9491079123427585, 0.1294849661688697},
                                         {-0.7415311855993945, 0.2797053914892766},
                                         {-0.4058451513773972, 0.3818300505051189},
                                         {0.0, 0.4179591836734694},
                                         {0.4058451513773972, 0.3818300505051189},
                                         {0.7415311855993945, 0.2797053914892766},
                                         {0.9491079123427585, 0.1294849661688697}}};

/// Gauss-Lobatto (Abramowitz and Stegun 25.4.32): its ends see a step that lies beside one of them.
/// They are drawn in a little, since the value just at a boundary of the domain (the horizon, say)
/// need not be the limit.
constexpr double kEnd = 1.0 - 1e-9;
constexpr std::array<Node, 5> kFive = {{{-kEnd, 0.1},
                                        {-0.6546536707079772, 49.0 / 90.0},
                                        {0.0, 32.0 / 45.0},
                                        {0.6546536707079772, 49.0 / 90.0},
                                        {kEnd, 0.1}}};

/// Where intervals are split: beside the middle, where the nodes of a rule and its halves would see
/// the same of a step.
constexpr double kSplit = 0.45;

double rule(const std::function<double(double)>& f, double a, double b) {
  const double centre = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = 0.0;
  for (const Node& n : kSeven) sum += n.weight * f(centre + half * n.x);
  return sum * half;
}

double refine(const std::function<double(double)>& f, double a, double b, double whole,
              double tolerance, int depth) {
  const double middle = a + kSplit * (b - a);
  const double left = rule(f, a, middle);
  const double right = rule(f, middle, b);
  if (depth == 0 || std::abs(left + right - whole) <= tolerance) return left + right;
  return refine(f, a, middle, left, 0.5 * tolerance, depth - 1) +
         refine(f, middle, b, right, 0.5 * tolerance, depth - 1);
}

using Plane = std::function<double(double, double)>;

double rule2(const Plane& f, double ax, double bx, double ay, double by) {
  const double cx = 0.5 * (ax + bx);
  const double hx = 0.5 * (bx - ax);
  const double cy = 0.5 * (ay + by);
  const double hy = 0.5 * (by - ay);
  double sum = 0.0;
  for (const Node& m : kFive) {
    for (const Node& n : kFive) sum += m.weight * n.weight * f(cx + hx * m.x, cy + hy * n.x);
  }
  return sum * hx * hy;
}

double refine2(const Plane& f, double ax, double bx, double ay, double by, double whole,
               double tolerance, int depth) {
  const double mx = ax + kSplit * (bx - ax);
  const double my = ay + kSplit * (by - ay);
  const double part[4] = {rule2(f, ax, mx, ay, my), rule2(f, mx, bx, ay, my),
                          rule2(f, ax, mx, my, by), rule2(f, mx, bx, my, by)};
  const double sum = part[0] + part[1] + part[2] + part[3];
  if (depth == 0 || std::abs(sum - whole) <= tolerance) return sum;
  // A half, not a quarter, of the tolerance goes down: errors of the parts are rarely alike.
  const double rest = 0.5 * tolerance;
  return refine2(f, ax, mx, ay, my, part[0], rest, depth - 1) +
         refine2(f, mx, bx, ay, my, part[1], rest, depth - 1) +
         refine2(f, ax, mx, my, by, part[2], rest, depth - 1) +
         refine2(f, mx, bx, my, by, part[3], rest, depth - 1);
}

}  // namespace

double integrate(const std::function<double(double)>& f, double a, double b, double tolerance,
                 int pieces, int depth) {
  double sum = 0.0;
  const double step = (b - a) / pieces;
  for (int i = 0; i < pieces; ++i) {
    const double x0 = a + step * i;
    const double x1 = i + 1 == pieces ? b : x0 + step;
    sum += refine(f, x0, x1, rule(f, x0, x1), tolerance / pieces, depth);
  }
  return sum;
}

double integrate2(const Plane& f, double ax, double bx, double ay, double by, double tolerance,
                  int pieces, int depth) {
  double sum = 0.0;
  const double dx = (bx - ax) / pieces;
  const double dy = (by - ay) / pieces;
  for (int j = 0; j < pieces; ++j) {
    for (int i = 0; i < pieces; ++i) {
      const double x0 = ax + dx * i;
      const double y0 = ay + dy * j;
      const double x1 = i + 1 == pieces ? bx : x0 + dx;
      const double y1 = j + 1 == pieces ? by : y0 + dy;
      sum += refine2(f, x0, x1, y0, y1, rule2(f, x0, x1, y0, y1), tolerance / (pieces * pieces),
                     depth);
    }
  }
  return sum;
}

core::Vec3 spherical(double z, double phi) {
  const double r = std::sqrt(std::fmax(0.0, (1.0 - z) * (1.0 + z)));
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
          static_cast<float>(z)};
}

double integrate_sphere(const std::function<double(const core::Vec3&)>& f, double z0, double z1,
                        double tolerance, int pieces, int depth) {
  return integrate2([&](double z, double phi) { return f(spherical(z, phi)); }, z0, z1, 0.0,
                    2.0 * M_PI, tolerance, pieces, depth);
}

}  // namespace hyades::test
