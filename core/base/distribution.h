#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// Chooses one of many entries in proportion to given weights. The cumulative weights are integers
/// in units of 2^-24, the grid of a sampler's numbers: the probabilities reported are exactly those
/// with which entries come. Every entry with a positive weight comes (so long as there are fewer
/// than 2^23 of them), one without never. Immutable after construction.
class Distribution1D {
 public:
  Distribution1D() = default;
  /// Weights below 0, infinite or NaN count as 0.
  explicit Distribution1D(std::span<const float> weights);

  struct Choice {
    uint32_t index = 0;
    float probability = 0.0F;  ///< of this entry; 0 only where all weights are 0
    float u = 0.0F;            ///< what is left of the random number, in [0, 1)
  };

  /// u in [0, 1).
  Choice sample(float u) const;

  float probability(uint32_t index) const {
    return static_cast<float>(cumulative_[index + 1] - cumulative_[index]) * 0x1p-24F;
  }
  /// The u for which sample() returns this entry and remainder.
  float invert(uint32_t index, float remainder) const;

  uint32_t size() const { return size_; }
  double total() const { return total_; }  ///< sum of the weights
  bool empty() const { return !(total_ > 0.0); }

 private:
  friend class Distribution2D;
  uint32_t size_ = 0;
  double total_ = 0.0;
  std::vector<uint32_t> cumulative_;  // size_ + 1 entries from 0 to 2^24
};

/// A density on the unit square, constant in each cell of a grid (cell (0, 0) at u = (0, 0)): rows
/// by their sums, then a cell within its row.
class Distribution2D {
 public:
  Distribution2D() = default;
  /// `weights` by rows, width * height of them, at most 2^23 in a row or column.
  Distribution2D(std::span<const float> weights, uint32_t width, uint32_t height);

  struct Point {
    Vec2 at{0.0F};     ///< in [0, 1)^2
    float pdf = 0.0F;  ///< per unit area of the square; 0 only where all weights are 0
    uint32_t x = 0;    ///< its cell
    uint32_t y = 0;
  };

  /// u in [0, 1)^2.
  Point sample(const Vec2& u) const;
  float pdf(const Vec2& at) const;    ///< 0 outside the unit square
  Vec2 invert(const Vec2& at) const;  ///< u with sample(u).at = at, where pdf(at) > 0
  double mean() const;                ///< of the weights: the integral of the density they make
  bool empty() const { return rows_.empty(); }

 private:
  std::span<const uint32_t> row(uint32_t y) const {
    return {cells_.data() + size_t{y} * (width_ + 1), width_ + size_t{1}};
  }
  uint32_t width_ = 0;
  uint32_t height_ = 0;
  Distribution1D rows_;
  std::vector<uint32_t> cells_;  // per row width + 1 cumulative weights in units of 2^-24
};

}  // namespace hyades::core
