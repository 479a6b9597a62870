#include "core/media/nanovdb_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/media/nanovdb_layout.h"

namespace hyades::core {
namespace {

/// Offsets in a tree's head, from its beginning.
constexpr size_t kRootOffset = 24;

constexpr size_t kUpperPlaces = 32 * 32 * 32;
constexpr size_t kLowerPlaces = 16 * 16 * 16;
constexpr int kUpperSide = 4096;  ///< voxels
constexpr int kLowerSide = 128;
constexpr int kLeafSide = 8;

float value_at(const std::byte* at, NanoType type, float) {
  float value = 0.0F;
  double large = 0.0;
  if (type != NanoType::real64) std::memcpy(&value, at, sizeof(value));
  if (type == NanoType::real64) std::memcpy(&large, at, sizeof(large));
  return type == NanoType::real64 ? static_cast<float>(large) : value;
}
Rgb value_at(const std::byte* at, NanoType, const Rgb&) {
  std::array<float, 3> c{};
  std::memcpy(c.data(), at, sizeof(c));
  return {c[0], c[1], c[2]};
}

/// Values below 0 count as 0.
float cleaned(float x, bool& finite) {
  finite = finite && std::isfinite(x);
  return std::max(x, 0.0F);
}
Rgb cleaned(const Rgb& c, bool& finite) {
  return {cleaned(c.x, finite), cleaned(c.y, finite), cleaned(c.z, finite)};
}

/// The codes of a quantized leaf, `bits` each.
uint32_t code_at(const std::byte* codes, size_t i, size_t bits) {
  uint16_t code = 0;
  if (bits == 16) {
    std::memcpy(&code, codes + 2 * i, sizeof(code));
    return code;
  }
  const size_t place = i * bits;
  return (static_cast<uint32_t>(codes[place / 8]) >> (place % 8)) & ((1U << bits) - 1U);
}

template <class T>
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, NanoType type, size_t most_blocks)
      : bytes_(bytes), type_(type), layout_(type), most_blocks_(most_blocks) {}

  Result<VdbTree<T>> read() {
    read_root();
    if (problem_ == nullptr && !finite_) problem_ = "has values that are not finite numbers";
    if (problem_ != nullptr) return Error{problem_};
    return std::move(tree_);
  }

 private:
  void fail(const char* problem) {
    if (problem_ == nullptr) problem_ = problem;
  }

  /// Whether `size` bytes lie `offset` after `from`; `place` is where.
  bool follow(size_t from, int64_t offset, size_t size, size_t& place) {
    const auto total = static_cast<int64_t>(bytes_.size());
    const auto base = static_cast<int64_t>(from);
    const bool inside = offset >= -base && offset <= total - base &&
                        static_cast<int64_t>(size) <= total - base - offset;
    if (inside) place = static_cast<size_t>(base + offset);
    if (!inside) fail("ends too early, or leads out of itself");
    return inside;
  }

  template <class V>
  V at(size_t place) const {
    V value;
    std::memcpy(&value, bytes_.data() + place, sizeof(value));
    return value;
  }
  bool bit(size_t mask, size_t i) const {
    return (at<uint64_t>(mask + i / 64 * 8) >> (i % 64) & 1U) != 0;
  }

  /// Counts a node of `size` bytes: there are no more than have room side by side.
  bool enter(size_t size, size_t& count) {
    if (++count <= bytes_.size() / size) return problem_ == nullptr;
    fail("has nodes that lie over one another");
    return false;
  }

  void read_root() {
    size_t root = 0;
    size_t rest = 0;
    const size_t tree = kNanoGridBytes;
    if (!follow(0, 0, tree + 64, rest)) return;
    if (!follow(tree, at<int64_t>(tree + kRootOffset), layout_.root(), root)) return;
    const auto tiles = size_t{at<uint32_t>(root + NanoLayout::kTileCount)};
    if (!follow(root, static_cast<int64_t>(layout_.root()), tiles * NanoLayout::kTile, rest)) {
      return;
    }
    for (size_t i = 0; i < tiles && problem_ == nullptr; ++i) {
      const size_t tile = rest + i * NanoLayout::kTile;
      const auto child = at<int64_t>(tile + NanoLayout::kTileChild);
      if (child == 0) {
        if (at<uint32_t>(tile + NanoLayout::kTileActive) != 0) {
          fail("has an active region of 4096 voxels a side");
        }
        continue;
      }
      size_t place = 0;
      if (!follow(root, child, layout_.inner(kUpperPlaces), place)) return;
      const Vec3i origin = origin_of(at<uint64_t>(tile));
      if (enter(layout_.inner(kUpperPlaces), uppers_)) {
        read_inner(place, origin, kUpperPlaces, kUpperSide);
      }
    }
  }

  /// A key is made of the upper 20 bits of z, y and x, 21 bits each.
  Vec3i origin_of(uint64_t key) {
    const auto part = [&](unsigned shift) {
      return static_cast<int32_t>(static_cast<uint32_t>(key >> shift & 0x1FFFFFU) << 12U);
    };
    const Vec3i origin(part(42), part(21), part(0));
    constexpr int kFarthest = 1 << 22;
    if (origin != glm::clamp(origin, Vec3i(-kFarthest), Vec3i(kFarthest))) {
      fail("lies more than four million voxels from its origin");
    }
    return origin;
  }

  void read_inner(size_t node, const Vec3i& origin, size_t places, int side) {
    const bool is_upper = places == kUpperPlaces;
    const int child_side = is_upper ? kLowerSide : kLeafSide;
    const auto across = static_cast<size_t>(side / child_side);
    const size_t active = node + NanoLayout::kMasks;
    const size_t children = active + places / 8;
    const size_t child_size = is_upper ? layout_.inner(kLowerPlaces) : layout_.leaf();
    for (size_t i = 0; i < places && problem_ == nullptr; ++i) {
      const size_t entry = node + layout_.table(places) + i * layout_.entry();
      const Vec3i corner =
          origin + child_side * Vec3i(i / across / across, i / across % across, i % across);
      if (!bit(children, i)) {
        if (bit(active, i)) fill(corner, child_side, entry);
        continue;
      }
      size_t place = 0;
      if (!follow(node, at<int64_t>(entry), child_size, place)) return;
      if (!enter(child_size, is_upper ? lowers_ : leaves_)) return;
      if (is_upper) {
        read_inner(place, corner, kLowerPlaces, kLowerSide);
      } else {
        read_leaf(place, corner);
      }
    }
  }

  void fill(const Vec3i& origin, int side, size_t entry) {
    const T value = cleaned(value_at(bytes_.data() + entry, type_, T()), finite_);
    if (!tree_.fill(origin, side, value, most_blocks_)) too_many();
  }

  void too_many() { fail("has more active voxels than can be read"); }

  void read_leaf(size_t leaf, const Vec3i& origin) {
    std::array<uint64_t, 8> active{};
    std::memcpy(active.data(), bytes_.data() + leaf + NanoLayout::kLeafMask, sizeof(active));
    if (std::all_of(active.begin(), active.end(), [](uint64_t word) { return word == 0; })) return;
    const size_t values = leaf + layout_.leaf_values();
    size_t bits = 0;
    if (layout_.quantized && !codes_of(leaf, bits)) return;
    auto* block = tree_.new_block(origin, most_blocks_);
    if (block == nullptr) return too_many();
    block->active = active;
    for (size_t i = 0; i < 512; ++i) {
      if ((active[i / 64] >> (i % 64) & 1U) == 0) continue;
      T value;
      if (layout_.quantized) {
        const auto code = static_cast<float>(code_at(bytes_.data() + values, i, bits));
        value = T(code * at<float>(leaf + NanoLayout::kLeafStep) +
                  at<float>(leaf + NanoLayout::kLeafLeast));
      } else {
        value = value_at(bytes_.data() + values + i * layout_.value, type_, T());
      }
      block->values[i] = cleaned(value, finite_);
      const auto n = static_cast<int>(i);
      const Vec3i p = origin + Vec3i(n >> 6, (n >> 3) & 7, n & 7);
      tree_.include(p, p);
    }
  }

  /// How many bits the codes of a leaf have; whether they are there.
  bool codes_of(size_t leaf, size_t& bits) {
    bits = type_ == NanoType::quantized4   ? 4
           : type_ == NanoType::quantized8 ? 8
           : type_ == NanoType::quantized16
               ? 16
               : size_t{1} << (static_cast<uint32_t>(bytes_[leaf + NanoLayout::kLeafFlags]) >> 5U);
    size_t place = 0;
    if (bits > 16) fail("has a node of an unknown kind");
    return bits <= 16 &&
           follow(leaf, static_cast<int64_t>(layout_.leaf_values()), 64 * bits, place);
  }

  std::span<const std::byte> bytes_;
  NanoType type_;
  NanoLayout layout_;
  size_t most_blocks_;
  size_t uppers_ = 0;
  size_t lowers_ = 0;
  size_t leaves_ = 0;
  bool finite_ = true;
  const char* problem_ = nullptr;
  VdbTree<T> tree_;
};

}  // namespace

template <class T>
Result<VdbTree<T>> read_nanovdb_tree(std::span<const std::byte> grid, NanoType type,
                                     size_t most_blocks) {
  return Reader<T>(grid, type, most_blocks).read();
}

template Result<VdbTree<float>> read_nanovdb_tree(std::span<const std::byte>, NanoType, size_t);
template Result<VdbTree<Rgb>> read_nanovdb_tree(std::span<const std::byte>, NanoType, size_t);

}  // namespace hyades::core
