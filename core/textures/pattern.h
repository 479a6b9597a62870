#pragma once

#include <memory>
#include <optional>

#include "core/base/vec.h"
#include "core/textures/noise.h"

namespace hyades::core {

/// A number from 0 to 1 at every place of space, and its gradient (exact; zero where it jumps).
/// Immutable and thread-safe.
class Pattern {
 public:
  virtual ~Pattern() = default;
  virtual Noise3 at(const Vec3& p) const = 0;
};

using PatternPtr = std::shared_ptr<const Pattern>;

/// Octaves of Perlin noise, in three dimensions, or in four where there is a time.
struct FractalDesc {
  int octaves = 1;
  float lacunarity = 2.0F;  ///< frequency ratio of neighbouring octaves
  float gain = 0.5F;        ///< amplitude ratio
  std::optional<float> time = std::nullopt;
};

enum class FractalKind {
  fbm,         ///< 0.5 + 0.5 fbm()
  turbulence,  ///< of |noise|: creases where it is 0 (Perlin 1985, "An Image Synthesizer")
  ridged,      ///< of (1 - |noise|)^2: crests there (Musgrave's ridges, without their feedback)
};

/// The octaves' weighted mean.
PatternPtr make_fractal_pattern(FractalKind kind, const FractalDesc& desc);

/// Layers across x, one per unit, bent by `distortion` [units] times fbm:
/// 0.5 + 0.5 sin(2 pi (x + distortion fbm)).
PatternPtr make_marble_pattern(const FractalDesc& desc, float distortion);

/// Rings around the y axis, one per unit, bent by `distortion` [units] times fbm: each rises slowly
/// from 0 to 1 and falls back within the last tenth of its width, smoothly.
PatternPtr make_wood_pattern(const FractalDesc& desc, float distortion);

enum class CellMetric {
  euclidean,
  manhattan,  ///< sum of the differences
  chebyshev,  ///< the largest one
};

enum class CellFeature {
  f1,       ///< distance to the nearest point
  f2,       ///< to the second nearest
  edges,    ///< the second less the first: 0 on the edges of cells
  cell_id,  ///< a number per cell, at random
};

struct CellularDesc {
  CellMetric metric = CellMetric::euclidean;
  CellFeature feature = CellFeature::f1;
  float jitter = 1.0F;                       ///< how far points are from their cells' middles, 0..1
  std::optional<float> time = std::nullopt;  ///< in the fourth dimension; none: three
};

/// One point per unit cell (Worley 1996, "A Cellular Texture Basis Function"); values count up
/// to 1.
PatternPtr make_cellular_pattern(const CellularDesc& desc);

/// Bricks in the xy plane, 1 x 1: 0 within, 1 in the mortar that takes `mortar` (0..1) of a
/// brick's sides. Every other row is moved by `shift` of a brick. `softness` (0..1) of the way from
/// a brick's edge to its middle is not yet all brick.
PatternPtr make_brick_pattern(float mortar, float shift, float softness);

/// Lines across x, one per unit, in the xy plane where `grid`: 1 on `width` (0..1) of a cell,
/// around whole numbers, 0 elsewhere; edges as soft as bricks'.
PatternPtr make_line_pattern(bool grid, float width, float softness);

enum class GradientShape {
  linear,       ///< x
  radial,       ///< distance from the z axis
  cylindrical,  ///< distance from the y axis
  spherical,    ///< distance from the origin
  angular,      ///< turn around the z axis from x to y, 0..1 once around
};

/// From 0 to 1 within a unit, held beyond.
PatternPtr make_gradient_pattern(GradientShape shape);

}  // namespace hyades::core
