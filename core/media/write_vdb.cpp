#include "core/media/write_vdb.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

namespace hyades::core {
namespace {

constexpr int kLeafBits = 3;    ///< 8 voxels a side
constexpr int kLowerBits = 7;   ///< of an inner node: 16 leaves a side
constexpr int kUpperBits = 12;  ///< of a child of the root: 32 inner nodes a side

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    bytes_->append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T>
  void put_at(size_t place, const T& value) {
    std::memcpy(bytes_->data() + place, &value, sizeof(T));
  }
  void put_text(const std::string& text) {
    put(static_cast<uint32_t>(text.size()));
    bytes_->append(text);
  }
  void put_words(const std::vector<uint64_t>& words) {
    for (const uint64_t word : words) put(word);
  }
  size_t size() const { return bytes_->size(); }
  Bytes take() {
    const auto view = std::as_bytes(std::span(bytes_->data(), bytes_->size()));
    return {std::move(bytes_), view};
  }

 private:
  std::shared_ptr<std::string> bytes_ = std::make_shared<std::string>();
};

/// Nodes by their first voxels.
struct Before {
  bool operator()(const Vec3i& a, const Vec3i& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};
template <class T>
using ByPlace = std::map<Vec3i, T, Before>;

/// The leaves of a tree, below the inner nodes that hold them.
using Tree = ByPlace<ByPlace<std::vector<Vec3i>>>;

Vec3i node_of(const Vec3i& voxel, int bits) { return (voxel >> bits) << bits; }

class BoxWriter {
 public:
  BoxWriter(const VdbBox& box, Writer& out)
      : box_(box), components_(box.colors ? 3 : 1), out_(out) {}

  void write() {
    put_header();
    std::vector<Vec3i> leaves;
    const Tree tree = filled();
    out_.put(uint32_t{1});  // buffers
    put_zero();             // the background
    out_.put(uint32_t{0});  // tiles
    out_.put(static_cast<uint32_t>(tree.size()));
    for (const auto& [origin, inner] : tree) {
      for (int a = 0; a < 3; ++a) out_.put(int32_t{origin[a]});
      put_mask(origin, inner, kUpperBits, kLowerBits);
      for (const auto& [place, below] : inner) {
        ByPlace<int> children;
        for (const Vec3i& leaf : below) children.emplace(leaf, 0);
        put_mask(place, children, kLowerBits, kLeafBits);
        for (const Vec3i& leaf : below) {
          put_leaf_mask(leaf);
          leaves.push_back(leaf);
        }
      }
    }
    for (const Vec3i& leaf : leaves) {
      put_leaf_mask(leaf);
      out_.put(uint8_t{6});  // all values follow
      for (size_t i = 0; i < 512; ++i) {
        const float* value = at(voxel_of(leaf, i));
        for (size_t c = 0; c < components_; ++c) out_.put(value == nullptr ? 0.0F : value[c]);
      }
    }
  }

 private:
  void put_header() {
    out_.put(uint32_t{0});  // not compressed
    out_.put(uint32_t{2});  // metadata
    for (const auto& [key, value] :
         {std::pair<const char*, std::string>("class", "fog volume"), {"name", box_.name}}) {
      out_.put_text(key);
      out_.put_text("string");
      out_.put_text(value);
    }
    if (box_.map) {
      // Row by row, of a matrix that vectors stand left of.
      out_.put_text("AffineMap");
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) out_.put(static_cast<double>((*box_.map)[i][j]));
      }
      return;
    }
    out_.put_text("ScaleTranslateMap");
    const auto put_three = [&](const Vec3d& v) {
      for (int a = 0; a < 3; ++a) out_.put(v[a]);
    };
    put_three(box_.origin);
    put_three(box_.voxel);
    put_three(glm::abs(box_.voxel));
    put_three(1.0 / box_.voxel);
    put_three(1.0 / (box_.voxel * box_.voxel));
    put_three(0.5 / box_.voxel);
  }

  const float* at(const Vec3i& voxel) const {
    const Vec3i p = voxel - box_.lower;
    if (p != glm::clamp(p, Vec3i(0), box_.size - 1)) return nullptr;
    const size_t i =
        (static_cast<size_t>(p.z) * static_cast<size_t>(box_.size.y) + static_cast<size_t>(p.y)) *
            static_cast<size_t>(box_.size.x) +
        static_cast<size_t>(p.x);
    return box_.values.data() + i * components_;
  }

  static Vec3i voxel_of(const Vec3i& leaf, size_t i) {
    const auto n = static_cast<int>(i);
    return leaf + Vec3i(n >> 6, (n >> 3) & 7, n & 7);
  }

  bool is_on(const Vec3i& voxel) const {
    const float* value = at(voxel);
    if (value == nullptr) return false;
    return std::any_of(value, value + components_, [](float x) { return x != 0.0F; });
  }

  Tree filled() const {
    Tree tree;
    const Vec3i first = node_of(box_.lower, kLeafBits);
    const Vec3i last = box_.lower + box_.size - 1;
    Vec3i leaf;
    for (leaf.x = first.x; leaf.x <= last.x; leaf.x += 8) {
      for (leaf.y = first.y; leaf.y <= last.y; leaf.y += 8) {
        for (leaf.z = first.z; leaf.z <= last.z; leaf.z += 8) {
          bool any = false;
          for (size_t i = 0; i < 512 && !any; ++i) any = is_on(voxel_of(leaf, i));
          if (any) tree[node_of(leaf, kUpperBits)][node_of(leaf, kLowerBits)].push_back(leaf);
        }
      }
    }
    return tree;
  }

  void put_zero() {
    for (size_t c = 0; c < components_; ++c) out_.put(0.0F);
  }

  /// Which children an inner node has; none of its own values is active, all are 0.
  template <class Children>
  void put_mask(const Vec3i& origin, const Children& children, int bits, int child_bits) {
    const int side_bits = bits - child_bits;
    const size_t places = size_t{1} << (3 * side_bits);
    std::vector<uint64_t> mask(places / 64);
    for (const auto& child : children) {
      const Vec3i cell = (child.first - origin) >> child_bits;
      const auto i = static_cast<size_t>((((cell.x << side_bits) | cell.y) << side_bits) | cell.z);
      mask[i / 64] |= uint64_t{1} << (i % 64);
    }
    out_.put_words(mask);
    out_.put_words(std::vector<uint64_t>(places / 64));
    out_.put(uint8_t{6});  // all values follow
    for (size_t i = 0; i < places; ++i) put_zero();
  }

  void put_leaf_mask(const Vec3i& leaf) {
    std::vector<uint64_t> mask(8);
    for (size_t i = 0; i < 512; ++i) {
      if (is_on(voxel_of(leaf, i))) mask[i / 64] |= uint64_t{1} << (i % 64);
    }
    out_.put_words(mask);
  }

  const VdbBox& box_;
  size_t components_;
  Writer& out_;
};

Status check(const VdbBox& box) {
  double count = box.colors ? 3.0 : 1.0;
  for (int a = 0; a < 3; ++a) {
    if (box.size[a] < 1 || box.size[a] > kMostVdbSide || box.lower[a] < -kMostVdbSide ||
        box.lower[a] > kMostVdbSide) {
      return Error{"the grid '" + box.name + "' is empty or too large"};
    }
    if (!(box.voxel[a] > 0.0)) return Error{"the grid '" + box.name + "' has voxels of no size"};
    count *= box.size[a];
  }
  if (static_cast<double>(box.values.size()) != count) {
    return Error{"the grid '" + box.name + "' has not as many values as points"};
  }
  return {};
}

}  // namespace

Result<Bytes> write_vdb(const std::vector<VdbBox>& boxes) {
  Writer out;
  out.put(int64_t{0x56444220});
  out.put(uint32_t{224});  // of the format
  out.put(uint32_t{10});   // of the library that is made believe to have written it
  out.put(uint32_t{0});
  out.put(uint8_t{1});  // grids say where they end
  for (const char c : std::string("00000000-0000-0000-0000-000000000000")) out.put(c);
  out.put(uint32_t{0});  // metadata
  out.put(static_cast<int32_t>(boxes.size()));
  for (const VdbBox& box : boxes) {
    if (Status s = check(box); !s) return s.error();
    out.put_text(box.name);
    out.put_text(box.colors ? "Tree_vec3s_5_4_3" : "Tree_float_5_4_3");
    out.put_text("");  // shares no other grid's tree
    const size_t places = out.size();
    for (int i = 0; i < 3; ++i) out.put(int64_t{0});
    out.put_at(places, static_cast<int64_t>(out.size()));
    BoxWriter(box, out).write();
    out.put_at(places + 8, static_cast<int64_t>(out.size()));
    out.put_at(places + 16, static_cast<int64_t>(out.size()));
  }
  return out.take();
}

}  // namespace hyades::core
