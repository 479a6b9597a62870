#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core {

/// What the control points of a strand mean.
enum class CurveBasis {
  catmull_rom,  ///< the curve goes through all points
  bezier,       ///< cubic pieces that share their ends: 3 n + 1 points
  b_spline,  ///< uniform cubic: the curve comes near the points, and is smooth to the second order
};

/// One cubic piece of a strand as a polynomial in u, from 0 at its beginning to 1 at its end, in
/// double precision.
struct CurvePiece {
  std::array<Vec3d, 4> place{};  ///< coefficients of 1, u, u^2, u^3
  std::array<double, 4> radius{};

  Vec3d at(double u) const { return place[0] + u * (place[1] + u * (place[2] + u * place[3])); }
  Vec3d derivative(double u) const {
    return place[1] + u * (2.0 * place[2] + (3.0 * u) * place[3]);
  }
  Vec3d second_derivative(double u) const { return 2.0 * place[2] + (6.0 * u) * place[3]; }
  double radius_at(double u) const {
    return radius[0] + u * (radius[1] + u * (radius[2] + u * radius[3]));
  }
  double radius_derivative(double u) const {
    return radius[1] + u * (2.0 * radius[2] + (3.0 * u) * radius[3]);
  }
};

/// Round strands of hair, fur or grass in object space: tubes about cubic curves, open at both
/// ends. Positions are finite and radii at least 0: loaders make sure.
struct CurveSet {
  std::string name;  ///< file or description, for messages
  CurveBasis basis = CurveBasis::catmull_rom;
  std::vector<Vec4> points;       ///< control points of all strands, one after the other; w: radius
  std::vector<uint32_t> pieces;   ///< per cubic piece: the first of its four control points
  std::vector<uint32_t> strands;  ///< per strand: its first piece; and the number of all pieces
  std::vector<Vec3> colors;       ///< per control point, linear Rec.709; or empty
  Bounds bounds;                  ///< of the tubes

  CurvePiece piece(uint32_t index) const;
  Bounds bounds_of(uint32_t piece) const;  ///< of its tube
  size_t strand_count() const { return strands.size() - 1; }

  /// How far along its strand the place `u` (0..1) of a piece is: 0 at the root, 1 at the tip.
  float along_strand(uint32_t piece, float u) const;

  /// The colour there; white where there is none.
  Vec3 color_at(uint32_t piece, float u) const;
};

/// The strands as a file lists them.
struct StrandList {
  std::vector<Vec3> points;
  std::vector<float> radii;     ///< per point
  std::vector<Vec3> colors;     ///< per point; or empty
  std::vector<uint32_t> sizes;  ///< points of each strand, one after the other
};

/// Makes curves of them. Errors: a strand that has too few points for its basis (or for `bezier`
/// not 3 n + 1), a number that is not finite, a radius below 0, no strand at all, more points than
/// four thousand million.
Result<std::shared_ptr<CurveSet>> make_curve_set(const StrandList& list, CurveBasis basis);

}  // namespace hyades::core
