#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/fixed128.h"

namespace hyades::core {

/// What one light path brings to one pixel.
struct PixelSplat {
  uint32_t pixel = 0;  ///< of the region, row by row
  std::array<float, 3> value{};
};

/// Squares are kept in this unit, so that those of the brightest splats that count (about 2^35)
/// stay within what a film can hold. Splats below 2^-17 have none.
inline constexpr double kSplatSquareUnit = 0x1p30;

/// A pixel's sums of splats, by channel.
struct SplatSums {
  std::array<Fixed128, 3> value{};
  std::array<Fixed128, 3> square{};  ///< of single splats, in units of kSplatSquareUnit
  friend bool operator==(const SplatSums&, const SplatSums&) = default;
  SplatSums& operator+=(const SplatSums& other);

  /// What a single splat of `value` leaves in a pixel.
  static SplatSums of(const std::array<float, 3>& value);
  /// Whether no sum of squares is negative.
  bool valid() const;
};

/// What splats leave in a pixel of one part of light (FilmLayout::part_names), whose variance
/// nobody asks.
struct PartSums {
  std::array<Fixed128, 3> value{};
  friend bool operator==(const PartSums&, const PartSums&) = default;
  PartSums& operator+=(const PartSums& other);

  static PartSums of(const std::array<float, 3>& value);
  bool valid() const { return true; }
};

/// What light paths, which may end at any pixel, brought to the pixels of a region: exact sums, so
/// that layers add up to the same bits in any order and grouping (invariant 2). Holds only the
/// pixels that were touched while those are few, all of them otherwise. Not thread-safe.
template <class PixelSums>
class BasicSplatLayer {
 public:
  using Sums = PixelSums;
  struct Entry {
    uint32_t pixel = 0;
    Sums sums;
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  BasicSplatLayer() = default;
  /// `region`: full-frame pixels, at most 2^32 - 1 of them.
  explicit BasicSplatLayer(PixelRect region) : region_(region) {}

  const PixelRect& region() const { return region_; }

  /// Whether no pixel holds anything.
  bool empty() const;

  /// Adds splats, in any order. Values are finite; beyond +-kMaxDeposit they are clamped.
  void deposit(std::vector<PixelSplat> splats);

  /// Adds all of `other`, which has the same region. A frame's layer, to which many small ones
  /// come, soon holds all pixels: adding one of those costs no more than its entries then.
  void merge(const BasicSplatLayer& other);

  /// Takes memory for every pixel.
  void spread();

  /// Every pixel's sums, row by row; empty while only those are held that were touched.
  std::span<const Sums> all() const { return all_; }

  /// What a pixel of the region holds.
  Sums at(int x, int y) const;

  /// Bytes that it takes.
  uint64_t memory() const { return entries_.size() * sizeof(Entry) + all_.size() * sizeof(Sums); }

  /// How many pixels hold something.
  uint64_t count() const;

  /// Calls visit(pixel, sums) for every pixel that holds something, in ascending order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const Entry& entry : entries_) {
      if (entry.sums != Sums{}) visit(entry.pixel, entry.sums);
    }
    for (size_t i = 0; i < all_.size(); ++i) {
      if (all_[i] != Sums{}) visit(static_cast<uint32_t>(i), all_[i]);
    }
  }

  /// Adds entries in ascending order of their pixels, each once. For readers of files.
  void add(std::vector<Entry> entries);

  /// Whether no sum of squares is negative, for layers that were read.
  Status check() const;

  /// SHA-256, in hex, of what the pixels hold: equal sums, equal digests, however they are kept.
  std::string digest() const;

 private:
  void add(std::vector<Entry> entries, size_t sparse);

  PixelRect region_;
  std::vector<Entry> entries_;  ///< ascending; empty once all_ is there
  std::vector<Sums> all_;       ///< of every pixel of the region, or empty
};

extern template class BasicSplatLayer<SplatSums>;
extern template class BasicSplatLayer<PartSums>;
using SplatLayer = BasicSplatLayer<SplatSums>;
using PartSplatLayer = BasicSplatLayer<PartSums>;

}  // namespace hyades::core
