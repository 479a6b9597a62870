#include "core/geometry/curve_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace hyades::core {
namespace {

/// The rows of a basis: coefficients of 1, u, u^2, u^3 as weighted sums of four control points.
using BasisMatrix = std::array<std::array<double, 4>, 4>;

constexpr BasisMatrix kCatmullRom{
    {{0.0, 1.0, 0.0, 0.0}, {-0.5, 0.0, 0.5, 0.0}, {1.0, -2.5, 2.0, -0.5}, {-0.5, 1.5, -1.5, 0.5}}};
constexpr BasisMatrix kBezier{
    {{1.0, 0.0, 0.0, 0.0}, {-3.0, 3.0, 0.0, 0.0}, {3.0, -6.0, 3.0, 0.0}, {-1.0, 3.0, -3.0, 1.0}}};
constexpr BasisMatrix kBSpline{{{1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0, 0.0},
                                {-0.5, 0.0, 0.5, 0.0},
                                {0.5, -1.0, 0.5, 0.0},
                                {-1.0 / 6.0, 0.5, -0.5, 1.0 / 6.0}}};

const BasisMatrix& matrix_of(CurveBasis basis) {
  switch (basis) {
    case CurveBasis::bezier:
      return kBezier;
    case CurveBasis::b_spline:
      return kBSpline;
    default:
      return kCatmullRom;
  }
}

/// The control points of Bezier's that mean the same: the piece lies within their hull.
std::array<glm::dvec4, 4> hull_of(const CurvePiece& p) {
  const auto coefficient = [&](size_t k) { return glm::dvec4(p.place[k], p.radius[k]); };
  const glm::dvec4 a = coefficient(0);
  const glm::dvec4 b = coefficient(1) / 3.0;
  const glm::dvec4 c = coefficient(2) / 3.0;
  return {a, a + b, a + 2.0 * b + c, a + 3.0 * b + 3.0 * c + coefficient(3)};
}

Bounds tube_bounds(const CurvePiece& piece) {
  Bounds b;
  for (const glm::dvec4& h : hull_of(piece)) {
    const auto r =
        std::nextafter(static_cast<float>(std::abs(h.w)), std::numeric_limits<float>::infinity());
    const Vec3 place(h.x, h.y, h.z);
    const Vec3 margin = Vec3(r) + glm::abs(place) * 0x1p-22F;
    b.include(place - margin);
    b.include(place + margin);
  }
  return b;
}

/// How many points a strand of `size` points gets, and how many pieces; 0 pieces: it cannot be one.
struct StrandShape {
  size_t pieces = 0;
  size_t step = 1;      ///< control points from piece to piece
  bool padded = false;  ///< its ends are there twice
};
StrandShape shape_of(size_t size, CurveBasis basis) {
  switch (basis) {
    case CurveBasis::bezier:
      return {size >= 4 && size % 3 == 1 ? size / 3 : 0, 3, false};
    case CurveBasis::b_spline:
      return {size >= 4 ? size - 3 : 0, 1, false};
    default:
      return {size >= 2 ? size - 1 : 0, 1, true};
  }
}

const char* expected_size(CurveBasis basis) {
  switch (basis) {
    case CurveBasis::bezier:
      return "4, 7, 10, ... for basis: bezier";
    case CurveBasis::b_spline:
      return "at least 4 for basis: b-spline";
    default:
      return "at least 2";
  }
}

bool finite_place(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_point(const StrandList& list, size_t i) {
  if (!finite_place(list.points[i])) return Error{fmt::format("point {} is not finite", i)};
  if (!(list.radii[i] >= 0.0F && std::isfinite(list.radii[i]))) {
    return Error{fmt::format("the thickness of point {} is {}, expected at least 0", i,
                             2.0F * list.radii[i])};
  }
  return {};
}

}  // namespace

CurvePiece CurveSet::piece(uint32_t index) const {
  const BasisMatrix& m = matrix_of(basis);
  const Vec4* control = points.data() + pieces[index];
  CurvePiece out;
  for (size_t k = 0; k < 4; ++k) {
    glm::dvec4 sum(0.0);
    for (size_t i = 0; i < 4; ++i) sum += m[k][i] * glm::dvec4(control[i]);
    out.place[k] = Vec3d(sum);
    out.radius[k] = sum.w;
  }
  return out;
}

Bounds CurveSet::bounds_of(uint32_t piece) const { return tube_bounds(this->piece(piece)); }

float CurveSet::along_strand(uint32_t piece, float u) const {
  const auto after = std::upper_bound(strands.begin(), strands.end(), piece);
  const uint32_t first = *(after - 1);
  return (static_cast<float>(piece - first) + u) / static_cast<float>(*after - first);
}

Vec3 CurveSet::color_at(uint32_t piece, float u) const {
  if (colors.empty()) return Vec3(1.0F);
  const BasisMatrix& m = matrix_of(basis);
  const Vec3* control = colors.data() + pieces[piece];
  const double x = static_cast<double>(u);
  Vec3d sum(0.0);
  for (size_t i = 0; i < 4; ++i) {
    sum += (m[0][i] + x * (m[1][i] + x * (m[2][i] + x * m[3][i]))) * Vec3d(control[i]);
  }
  return glm::max(Vec3(sum), Vec3(0.0F));  // Catmull and Rom's overshoots
}

Result<std::shared_ptr<CurveSet>> make_curve_set(const StrandList& list, CurveBasis basis) {
  auto set = std::make_shared<CurveSet>();
  set->basis = basis;
  size_t points = 0;
  size_t pieces = 0;
  for (size_t s = 0; s < list.sizes.size(); ++s) {
    const StrandShape shape = shape_of(list.sizes[s], basis);
    if (shape.pieces == 0) {
      return Error{fmt::format("strand {} has {} points, expected {}", s, list.sizes[s],
                               expected_size(basis))};
    }
    points += list.sizes[s] + (shape.padded ? 2 : 0);
    pieces += shape.pieces;
  }
  if (pieces == 0) return Error{"it has no strands"};
  if (points > std::numeric_limits<uint32_t>::max()) return Error{"it has too many points"};
  set->points.reserve(points);
  set->pieces.reserve(pieces);
  set->strands.reserve(list.sizes.size() + 1);
  if (!list.colors.empty()) set->colors.reserve(points);
  const auto add = [&](size_t i) {
    set->points.emplace_back(list.points[i], list.radii[i]);
    if (!list.colors.empty()) set->colors.push_back(list.colors[i]);
  };
  size_t first = 0;
  for (const uint32_t size : list.sizes) {
    const StrandShape shape = shape_of(size, basis);
    set->strands.push_back(static_cast<uint32_t>(set->pieces.size()));
    const size_t begin = set->points.size();
    if (shape.padded) add(first);
    for (size_t i = first; i < first + size; ++i) {
      if (Status s = check_point(list, i); !s) return s.error();
      add(i);
    }
    if (shape.padded) add(first + size - 1);
    for (size_t k = 0; k < shape.pieces; ++k) {
      set->pieces.push_back(static_cast<uint32_t>(begin + k * shape.step));
    }
    first += size;
  }
  set->strands.push_back(static_cast<uint32_t>(set->pieces.size()));
  for (uint32_t i = 0; i < set->pieces.size(); ++i) set->bounds.include(set->bounds_of(i));
  return set;
}

}  // namespace hyades::core
