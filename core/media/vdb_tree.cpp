#include "core/media/vdb_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/media/vdb_values.h"

namespace hyades::core {
namespace {

/// One bit per place of a node.
class Mask {
 public:
  Mask(VdbCursor& cursor, size_t places) : words_(places / 64) {
    for (uint64_t& word : words_) word = cursor.read<uint64_t>();
  }
  bool on(size_t i) const { return (words_[i / 64] >> (i % 64) & 1U) != 0; }
  size_t count() const {
    size_t sum = 0;
    for (const uint64_t word : words_) sum += static_cast<size_t>(std::popcount(word));
    return sum;
  }
  const std::vector<uint64_t>& words() const { return words_; }

 private:
  std::vector<uint64_t> words_;
};

/// A level of inner nodes: 2^bits children along each axis, each of 2^child_bits voxels.
struct Level {
  int bits;
  int child_bits;
};
constexpr Level kUpper{5, 7};
constexpr Level kLower{4, 3};

Vec3i offset_of(size_t i, const Level& level) {
  const auto n = static_cast<int>(i);
  const int mask = (1 << level.bits) - 1;
  const Vec3i cell(n >> (2 * level.bits), (n >> level.bits) & mask, n & mask);
  return cell * (1 << level.child_bits);
}

float value_from(const float* components, float) { return components[0]; }
Rgb value_from(const float* components, const Rgb&) {
  return {components[0], components[1], components[2]};
}
float not_below_zero(float x) { return std::max(x, 0.0F); }
Rgb not_below_zero(const Rgb& c) { return glm::max(c, Rgb(0.0F)); }

}  // namespace

/// First come the masks of all nodes and the values of inner ones, then the values of the leaves in
/// the same order.
template <class T>
class VdbTreeReader {
 public:
  VdbTreeReader(VdbCursor& cursor, const VdbEncoding& encoding, size_t most_blocks)
      : cursor_(cursor), encoding_(encoding), most_blocks_(most_blocks) {}

  VdbTree<T> read() {
    cursor_.template read<uint32_t>();  // buffers: one
    const auto whole = static_cast<uint64_t>(encoding_.components * encoding_.component_bytes);
    cursor_.take(whole);  // the background
    const auto tiles = cursor_.template read<uint32_t>();
    const auto children = cursor_.template read<uint32_t>();
    for (uint32_t i = 0; i < tiles && cursor_.ok(); ++i) {
      cursor_.take(3 * sizeof(int32_t) + whole);
      if (cursor_.template read<uint8_t>() != 0) {
        cursor_.fail("has an active region of 4096 voxels a side");
      }
    }
    for (uint32_t i = 0; i < children && cursor_.ok(); ++i) read_inner(read_origin(), kUpper);
    for (size_t i = 0; i < leaves_.size() && cursor_.ok(); ++i) read_leaf(leaves_[i]);
    return std::move(tree_);
  }

 private:
  Vec3i read_origin() {
    Vec3i origin;
    for (int a = 0; a < 3; ++a) origin[a] = cursor_.template read<int32_t>();
    constexpr int kFarthest = 1 << 22;
    if (origin != glm::clamp(origin, Vec3i(-kFarthest), Vec3i(kFarthest))) {
      cursor_.fail("lies more than four million voxels from its origin");
    }
    return origin;
  }

  T next_value(const VdbValues& values, size_t i, size_t& next) {
    const size_t at = values.active_alone ? next++ : i;
    const float* components =
        values.components.data() + at * static_cast<size_t>(encoding_.components);
    for (int c = 0; c < encoding_.components; ++c) {
      if (!std::isfinite(components[c])) cursor_.fail("has values that are not finite numbers");
    }
    return not_below_zero(value_from(components, T()));
  }

  void read_inner(const Vec3i& origin, const Level& level) {
    const size_t places = size_t{1} << (3 * level.bits);
    const Mask children(cursor_, places);
    const Mask active(cursor_, places);
    const VdbValues values = read_vdb_values(cursor_, encoding_, places, active.count());
    size_t next = 0;
    for (size_t i = 0; i < places && cursor_.ok(); ++i) {
      if (!active.on(i)) continue;
      const T value = next_value(values, i, next);
      if (!children.on(i)) fill(origin + offset_of(i, level), 1 << level.child_bits, value);
    }
    for (size_t i = 0; i < places && cursor_.ok(); ++i) {
      if (!children.on(i)) continue;
      const Vec3i child = origin + offset_of(i, level);
      if (level.child_bits == kUpper.child_bits) {
        read_inner(child, kLower);
      } else {
        cursor_.take(512 / 8);  // its mask comes again with its values
        leaves_.push_back(child);
      }
    }
  }

  /// A region of one value.
  void fill(const Vec3i& origin, int side, const T& value) {
    if (!tree_.fill(origin, side, value, most_blocks_)) too_many();
  }

  void read_leaf(const Vec3i& origin) {
    const Mask active(cursor_, 512);
    const VdbValues values = read_vdb_values(cursor_, encoding_, 512, active.count());
    if (!cursor_.ok() || active.count() == 0) return;
    auto* block = tree_.new_block(origin, most_blocks_);
    if (block == nullptr) return too_many();
    std::copy(active.words().begin(), active.words().end(), block->active.begin());
    size_t next = 0;
    for (size_t i = 0; i < 512; ++i) {
      if (!active.on(i)) continue;
      block->values[i] = next_value(values, i, next);
      const auto n = static_cast<int>(i);
      const Vec3i p = origin + Vec3i(n >> 6, (n >> 3) & 7, n & 7);
      tree_.include(p, p);
    }
  }

  void too_many() { cursor_.fail("has more active voxels than can be read"); }

  VdbCursor& cursor_;
  VdbEncoding encoding_;
  size_t most_blocks_;
  std::vector<Vec3i> leaves_;
  VdbTree<T> tree_;
};

template <class T>
VdbTree<T> VdbTree<T>::read(VdbCursor& cursor, const VdbEncoding& encoding, size_t most_blocks) {
  return VdbTreeReader<T>(cursor, encoding, most_blocks).read();
}

template <class T>
bool VdbTree<T>::fill(const Vec3i& origin, int side, const T& value, size_t most_blocks) {
  const auto blocks_across = static_cast<size_t>(side / 8);
  if (blocks_across * blocks_across * blocks_across > most_blocks) return false;
  for (int x = 0; x < side; x += 8) {
    for (int y = 0; y < side; y += 8) {
      for (int z = 0; z < side; z += 8) {
        auto* block = new_block(origin + Vec3i(x, y, z), most_blocks);
        if (block == nullptr) return false;
        block->values.fill(value);
        block->active.fill(~uint64_t{0});
      }
    }
  }
  include(origin, origin + side - 1);
  return true;
}

template class VdbTree<float>;
template class VdbTree<Rgb>;

}  // namespace hyades::core
