#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/rect.h"
#include "core/film/unit.h"

namespace hyades::core {

/// A box of what a film holds: these batches of every pixel of this rectangle.
struct CoverageBox {
  PixelRect tile;
  BatchRange batches;
  friend bool operator==(const CoverageBox&, const CoverageBox&) = default;
};

/// The set of (pixel, batch) pairs that a film holds, as disjoint boxes. Kept small by joining
/// boxes that share a face as they come; canonical() depends on the set alone.
class Coverage {
 public:
  /// The overlap of `box` with what is held, if any (the first found).
  std::optional<CoverageBox> overlap(const CoverageBox& box) const;

  /// Adds `box`, which must not overlap. Joins neighbours.
  void add(const CoverageBox& box);

  /// Whether every pair of `box` is held.
  bool contains(const CoverageBox& box) const;

  /// Number of (pixel, batch) pairs held.
  uint64_t volume() const;

  const std::vector<CoverageBox>& boxes() const { return boxes_; }

  /// The same set cut and joined by a fixed rule, sorted: equal sets give equal vectors.
  std::vector<CoverageBox> canonical() const;

 private:
  std::vector<CoverageBox> boxes_;
};

}  // namespace hyades::core
