#include "core/geometry/meet_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hyades::core {
namespace {

constexpr int kParts = 8;
constexpr int kMostSteps = 12;

/// Two equations in (t, u): with R from the curve to the point, R is normal to the curve, and as
/// long as the radius.
class TubeEquations {
 public:
  TubeEquations(const CurvePiece& piece, const Vec3d& origin, const Vec3d& direction)
      : piece_(piece), origin_(origin), direction_(direction) {}

  /// A root near `start`; nothing where Newton's steps lead away from the piece.
  std::optional<CurveHit> solve(CurveHit start) const {
    for (int i = 0; i < kMostSteps; ++i) {
      const double u = start.u;
      const double t = start.t;
      const Vec3d tangent = piece_.derivative(u);
      const Vec3d r = origin_ + t * direction_ - piece_.at(u);
      const double radius = piece_.radius_at(u);
      const double f = glm::dot(r, tangent);
      const double g = glm::dot(r, r) - radius * radius;
      const double f_t = glm::dot(direction_, tangent);
      const double f_u = glm::dot(r, piece_.second_derivative(u)) - glm::dot(tangent, tangent);
      const double g_t = 2.0 * glm::dot(r, direction_);
      const double g_u = -2.0 * f - 2.0 * radius * piece_.radius_derivative(u);
      const double determinant = f_t * g_u - f_u * g_t;
      if (determinant == 0.0 || !std::isfinite(determinant)) return std::nullopt;
      const double dt = (f * g_u - f_u * g) / determinant;
      const double du = (f_t * g - f * g_t) / determinant;
      start.t = t - dt;
      // Far steps are cut: what lies beyond the piece is of no interest.
      start.u = std::clamp(u - du, -0.25, 1.25);
      if (!std::isfinite(start.t)) return std::nullopt;
      const bool still = std::abs(du) <= 1e-14 && std::abs(dt) <= 1e-14 * std::abs(start.t);
      if (still) break;
    }
    return is_root(start) ? std::optional(start) : std::nullopt;
  }

  /// Whether the line goes into the tube at a root.
  bool comes_in(const CurveHit& root) const {
    return glm::dot(origin_ + root.t * direction_ - piece_.at(root.u), direction_) < 0.0;
  }

 private:
  bool is_root(const CurveHit& at) const {
    constexpr double kSlack = 1e-9;
    if (!(at.u >= -kSlack && at.u <= 1.0 + kSlack)) return false;
    const Vec3d tangent = piece_.derivative(at.u);
    const Vec3d r = origin_ + at.t * direction_ - piece_.at(at.u);
    const double radius = piece_.radius_at(at.u);
    const double length = std::sqrt(glm::dot(r, r));
    const double leans = std::abs(glm::dot(r, tangent)) / std::sqrt(glm::dot(tangent, tangent));
    // Rounding of the place, far away from the origin of the ray.
    const double size = 1e-12 * (std::abs(at.t) * std::sqrt(glm::dot(direction_, direction_)) +
                                 std::sqrt(glm::dot(origin_, origin_)));
    return std::abs(length - radius) <= 1e-5 * radius + size && leans <= 1e-5 * radius + size;
  }

  const CurvePiece& piece_;
  const Vec3d& origin_;
  const Vec3d& direction_;
};

/// Where on the piece the line comes nearest to the straight part from u0 to u1, if it comes so
/// near that it may meet the tube.
std::optional<double> near_part(const CurvePiece& piece, const Vec3d& origin,
                                const Vec3d& direction, double u0, double u1) {
  const Vec3d a = piece.at(u0);
  const Vec3d axis = piece.at(u1) - a;
  const Vec3d from = origin - a;
  const double dd = glm::dot(direction, direction);
  const double da = glm::dot(direction, axis);
  const double aa = glm::dot(axis, axis);
  const double fd = glm::dot(from, direction);
  const double across = dd * aa - da * da;
  double s = across > 1e-12 * dd * aa ? (dd * glm::dot(from, axis) - da * fd) / across : 0.5;
  s = std::clamp(s, 0.0, 1.0);
  const double u = u0 + s * (u1 - u0);
  const Vec3d apart = from + direction * ((s * da - fd) / dd) - s * axis;
  const double radius = std::max({piece.radius_at(u), piece.radius_at(u0), piece.radius_at(u1)});
  const Vec3d bend = piece.second_derivative(u) * ((u1 - u0) * (u1 - u0));
  const double reach = 1.5 * radius + std::sqrt(glm::dot(bend, bend));
  if (!(glm::dot(apart, apart) <= reach * reach)) return std::nullopt;
  return u;
}

/// Where the line enters and leaves the straight tube about the tangent at `u`: a place beside it
/// where it does neither.
struct Crossing {
  CurveHit enter;
  CurveHit leave;
};
Crossing cross_tangent(const CurvePiece& piece, const Vec3d& origin, const Vec3d& direction,
                       double u) {
  const Vec3d axis = piece.derivative(u);
  const Vec3d from = origin - piece.at(u);
  const double aa = glm::dot(axis, axis);
  const double along_direction = aa > 0.0 ? glm::dot(direction, axis) / aa : 0.0;
  const double along_from = aa > 0.0 ? glm::dot(from, axis) / aa : 0.0;
  const Vec3d d = direction - along_direction * axis;
  const Vec3d f = from - along_from * axis;
  const double radius = piece.radius_at(u);
  // Rays along the axis are taken as a hundredth beside it.
  const double dd = std::max(glm::dot(d, d), 1e-4 * glm::dot(direction, direction));
  const double nearest = -glm::dot(f, d) / dd;
  const Vec3d apart = f + nearest * d;
  const double half2 = std::max(radius * radius - glm::dot(apart, apart), 0.01 * radius * radius);
  const double half = std::sqrt(half2 / dd);
  const auto place = [&](double t) {
    return CurveHit{t, std::clamp(u + along_from + t * along_direction, -0.25, 1.25)};
  };
  return {place(nearest - half), place(nearest + half)};
}

}  // namespace

std::optional<CurveHit> meet_curve(const CurvePiece& piece, const Vec3d& origin,
                                   const Vec3d& direction, double t_min, double t_max) {
  const TubeEquations equations(piece, origin, direction);
  std::optional<CurveHit> best;
  const auto take = [&](const std::optional<CurveHit>& root) {
    if (root && root->t > t_min && root->t < (best ? best->t : t_max)) best = root;
  };
  for (int part = 0; part < kParts; ++part) {
    const double u0 = part / static_cast<double>(kParts);
    const auto u = near_part(piece, origin, direction, u0, u0 + 1.0 / kParts);
    if (!u) continue;
    const Crossing crossing = cross_tangent(piece, origin, direction, *u);
    const auto enters = equations.solve(crossing.enter);
    take(enters);
    if (enters && enters->t > t_min && equations.comes_in(*enters)) continue;
    const auto leaves = equations.solve(crossing.leave);
    take(leaves);
    // Where the piece bends, where the line enters is known better from where it leaves.
    if (leaves) take(equations.solve(cross_tangent(piece, origin, direction, leaves->u).enter));
  }
  if (best) best->u = std::clamp(best->u, 0.0, 1.0);
  return best;
}

CurvePoint curve_point(const CurvePiece& piece, double u, const Vec3d& near) {
  CurvePoint out;
  const Vec3d axis = piece.at(u);
  out.tangent = piece.derivative(u);
  out.radius = piece.radius_at(u);
  Vec3d away = near - axis;
  const double length2 = glm::dot(away, away);
  away = length2 > 0.0 ? away / std::sqrt(length2) : Vec3d(0.0, 1.0, 0.0);
  out.outward = away;
  out.position = axis + away * out.radius;
  // A tube that gets thinner leans towards where it does.
  const Vec3d r = away * out.radius;
  const double f_u = glm::dot(r, piece.second_derivative(u)) - glm::dot(out.tangent, out.tangent);
  Vec3d normal = away;
  if (f_u != 0.0) normal = away + out.tangent * (piece.radius_derivative(u) / f_u);
  const double n2 = glm::dot(normal, normal);
  out.normal = n2 > 0.0 && std::isfinite(n2) ? normal / std::sqrt(n2) : away;
  return out;
}

}  // namespace hyades::core
