#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/unit.h"

namespace hyades::core {

/// A box of what a film holds: these batches of every pixel of this rectangle.
struct CoverageBox {
  PixelRect tile;
  BatchRange batches;
  friend bool operator==(const CoverageBox&, const CoverageBox&) = default;
};

/// The set of (pixel, batch) pairs that a film holds, as disjoint boxes. Kept small by joining
/// boxes that share a face as they come; canonical() depends on the set alone. Thousands of boxes
/// in any order stay cheap: rows of pixels are indexed, and what greedy joining left in pieces is
/// cut and joined afresh from time to time.
class Coverage {
 public:
  /// The overlap of `box` with what is held, if any (the first found).
  std::optional<CoverageBox> overlap(const CoverageBox& box) const;

  /// Adds `box`, which must not overlap. Joins neighbours. An empty box changes nothing.
  void add(const CoverageBox& box);

  /// Whether every pair of `box` is held.
  bool contains(const CoverageBox& box) const;

  /// Number of (pixel, batch) pairs held.
  uint64_t volume() const { return volume_; }

  const std::vector<CoverageBox>& boxes() const { return boxes_; }

  /// This set cut and joined by a fixed rule, sorted: equal sets give equal vectors. The rule:
  /// runs of rows whose content is the same, in them runs of columns that hold the same batches,
  /// in those the runs of batches, each as long as possible.
  std::vector<CoverageBox> canonical() const;

  /// The set whose canonical() is `boxes`, for readers of files: refuses what is no canonical form,
  /// in time proportional to their number (but for sorting).
  static Result<Coverage> from_canonical(const std::vector<CoverageBox>& boxes);

 private:
  template <class Visit>
  bool any_in_rows(int32_t y0, int32_t y1, const Visit& visit) const;
  bool join(CoverageBox& box);
  void insert(const CoverageBox& box);
  void remove(uint32_t id);
  void link(uint32_t id);
  void unlink(uint32_t id);
  void tidy();

  std::vector<CoverageBox> boxes_;
  uint64_t volume_ = 0;
  uint64_t adds_since_tidy_ = 0;
  /// Which boxes touch a run of rows, used once there are more than a few boxes: element i belongs
  /// to rows [(first_bucket_ + i) * kBucketRows, + kBucketRows). Boxes over very many rows are in
  /// tall_ instead.
  bool indexed_ = false;
  int32_t first_bucket_ = 0;
  std::vector<std::vector<uint32_t>> buckets_;
  std::vector<uint32_t> tall_;
};

}  // namespace hyades::core
