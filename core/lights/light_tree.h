#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lights/light_bounds.h"
#include "core/lights/light_selector.h"

namespace hyades::core {

/// A light, or all lights below: LightBounds made ready for being seen from many places.
struct LightTreeNode {
  Vec3 center{0.0F};            ///< of the box [m]
  float radius2 = 0.0F;         ///< of the ball around the box [m^2]
  Vec3 half_size{0.0F};         ///< of the box [m]
  float thickness2 = 0.0F;      ///< square of the middle one of the half sizes [m^2]
  Vec3 axis{0.0F, 1.0F, 0.0F};  ///< of the normals' cone
  float cos_normals = -1.0F;    ///< of that cone's angle
  float cos_beyond = 0.0F;      ///< LightBounds::cos_beyond
  float intensity = 0.0F;       ///< LightBounds::intensity; greater than 0
  uint32_t lights = 1;          ///< how many there are; the highest bit: two-sided
  uint32_t child = 0;  ///< its first child, the second follows; of leaves the light's index

  static constexpr uint32_t kTwoSided = 1U << 31U;
  uint32_t count() const { return lights & ~kTwoSided; }
  bool is_leaf() const { return count() == 1; }
};

/// A binary tree over finite lights, after Estevez & Kulla 2018, "Importance Sampling of Many
/// Lights with Adaptive Tree Splitting", sections 4.2 and 4.4: split where the children's areas,
/// times the solid angles they shine into, times their power, add up to the least. The same lights
/// in the same order make the same tree. Immutable; takes 128 bytes per light of a tree, and 8 per
/// light.
class LightTree {
 public:
  /// `index` of the light among all lights, of which there are `lights`.
  struct Entry {
    uint32_t index = 0;
    LightBounds bounds;
    ListBits receivers = kAllLists;  ///< the bit of the list that it is linked to
  };

  LightTree() = default;
  LightTree(std::vector<Entry> entries, size_t lights);

  bool empty() const { return nodes_.empty(); }
  const LightTreeNode& root() const { return nodes_[0]; }
  const LightTreeNode& child(const LightTreeNode& of, bool second) const {
    return nodes_[of.child + (second ? 1U : 0U)];
  }

  /// Whether a light of `node`, of this tree, is linked to what is in `lists`.
  bool links(const LightTreeNode& node, ListBits lists) const {
    return receivers_.empty() ||
           (receivers_[static_cast<size_t>(&node - nodes_.data())] & lists) != 0;
  }

  /// Whether light `index` is in the tree.
  bool holds(uint32_t index) const { return index < ways_.size() && ways_[index] != 0; }

  /// The way from the root to light `index`, from the lowest bit on: 1 where it goes to the second
  /// child. Only for lights that the tree holds; the way is as long as it takes to come to a leaf.
  uint64_t way_to(uint32_t index) const { return ways_[index]; }

 private:
  LightBounds build(uint32_t node, std::vector<Entry>& entries, size_t begin, size_t end,
                    uint64_t way, int depth);

  std::vector<LightTreeNode> nodes_;  ///< the root first, children always in pairs
  std::vector<ListBits> receivers_;   ///< by node, of all its lights; empty: all are linked to all
  std::vector<uint64_t> ways_;        ///< by light; 0: not in the tree; else with kEnd on top
};

}  // namespace hyades::core
