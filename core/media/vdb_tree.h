#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "core/base/vec.h"
#include "core/media/vdb_cursor.h"

namespace hyades::core {

/// How the values of a tree are stored.
struct VdbEncoding {
  uint32_t compression = 0;  ///< bits: 1 zip, 2 active values alone, 4 blosc
  int components = 1;        ///< of a value: 1 or 3
  int component_bytes = 4;   ///< 4: float, 8: double
  bool half = false;         ///< values, but for those of the root, are halves of floats
};

/// The active voxels of a tree of the usual shape (5, 4, 3), by blocks of 8 x 8 x 8. T: float or
/// Rgb. Values below 0 count as 0. Trees of .nvdb files have the same shape.
template <class T>
class VdbTree {
 public:
  struct Block {
    std::array<T, 512> values{};       ///< 0 where not active; z runs fastest, as in the file
    std::array<uint64_t, 8> active{};  ///< bit by bit
  };

  /// Reads the tree at the cursor, which may fail: the bytes end, something cannot be decompressed,
  /// a value is not finite, or there are more than `most_blocks`.
  static VdbTree read(VdbCursor& cursor, const VdbEncoding& encoding, size_t most_blocks);

  /// The block that voxel `p` lies in; null where nothing in it is active.
  const Block* block(const Vec3i& p) const {
    const auto found = blocks_.find(key(p));
    return found == blocks_.end() ? nullptr : &found->second;
  }
  /// Calls visit(origin) for every block, in any order.
  template <class Visit>
  void visit_blocks(const Visit& visit) const {
    const auto part = [](uint64_t k) {  // 21 bits with a sign
      return static_cast<int>(static_cast<int64_t>(k << 43U) >> 43U) * 8;
    };
    for (const auto& [k, block] : blocks_) visit(Vec3i(part(k >> 42U), part(k >> 21U), part(k)));
  }
  static size_t place(const Vec3i& p) {
    return static_cast<size_t>(((p.x & 7) << 6) | ((p.y & 7) << 3) | (p.z & 7));
  }

  /// The block of origin `origin`, to be filled; null where there are `most_blocks` already.
  Block* new_block(const Vec3i& origin, size_t most_blocks) {
    return blocks_.size() < most_blocks ? &blocks_[key(origin)] : nullptr;
  }
  /// Makes a region of `side`^3 voxels (a multiple of 8) active, with one value; false where that
  /// takes more than `most_blocks`.
  bool fill(const Vec3i& origin, int side, const T& value, size_t most_blocks);
  /// Tells that voxels from `lower` to `upper` are active.
  void include(const Vec3i& lower, const Vec3i& upper) {
    lower_ = glm::min(lower_, lower);
    upper_ = glm::max(upper_, upper);
  }

  size_t block_count() const { return blocks_.size(); }
  /// The active voxels lie in lower..upper, both included; lower > upper where there are none.
  const Vec3i& lower() const { return lower_; }
  const Vec3i& upper() const { return upper_; }

 private:
  /// 21 bits per axis: files reach as far as 2^23 voxels from the origin, which is enough.
  static uint64_t key(const Vec3i& p) {
    const auto part = [](int x) { return static_cast<uint64_t>(x >> 3) & 0x1FFFFFU; };
    return part(p.x) << 42U | part(p.y) << 21U | part(p.z);
  }

  std::unordered_map<uint64_t, Block> blocks_;
  Vec3i lower_{1 << 30};
  Vec3i upper_{-(1 << 30)};
};

}  // namespace hyades::core
