#pragma once

#include <algorithm>
#include <cstddef>

#include "core/media/nanovdb_file.h"

namespace hyades::core {

/// Where things lie in the nodes of NanoVDB's trees, in bytes; nodes and their tables of values
/// begin at multiples of 32.
struct NanoLayout {
  /// Of `type`, one of those that NanoType names.
  explicit constexpr NanoLayout(NanoType type)
      : value(type == NanoType::real64   ? 8
              : type == NanoType::vector ? 12
                                         : 4),
        alignment(type == NanoType::real64 ? 8 : 4),
        quantized(type >= NanoType::quantized4) {}

  size_t value;      ///< bytes of a value, but for those of quantized leaves
  size_t alignment;  ///< of a value
  bool quantized;

  static constexpr size_t up(size_t n, size_t to) { return (n + to - 1) / to * to; }

  /// Least, greatest, mean and deviation: the latter two are numbers.
  constexpr size_t statistics() const { return 2 * value + 2 * alignment; }

  /// A root: bounds and the number of its tiles, the background, statistics; then the tiles.
  static constexpr size_t kTileCount = 24;
  constexpr size_t root() const { return up(up(28, alignment) + value + statistics(), 32); }
  /// A tile: key, offset of its child, whether it is active, value.
  static constexpr size_t kTile = 32;
  static constexpr size_t kTileChild = 8;
  static constexpr size_t kTileActive = 16;

  /// An inner node of `places`: bounds, flags, masks of active values and of children, statistics,
  /// and a table of values or offsets.
  static constexpr size_t kMasks = 32;
  constexpr size_t table(size_t places) const {
    return up(kMasks + 2 * (places / 8) + statistics(), 32);
  }
  constexpr size_t entry() const { return up(std::max<size_t>(value, 8), 8); }
  constexpr size_t inner(size_t places) const { return table(places) + places * entry(); }

  /// A leaf: bounds, flags, mask of active values, statistics, 512 values. Of quantized ones least
  /// value and step stand in place of the first two statistics, and codes in place of values.
  static constexpr size_t kLeafFlags = 15;
  static constexpr size_t kLeafMask = 16;
  static constexpr size_t kLeafLeast = 80;
  static constexpr size_t kLeafStep = 84;
  constexpr size_t leaf_values() const {
    return quantized ? 96 : up(kLeafLeast + statistics(), 32);
  }
  /// Without the codes of those whose numbers of bits differ.
  constexpr size_t leaf() const { return leaf_values() + (quantized ? 0 : 512 * value); }
};

}  // namespace hyades::core
