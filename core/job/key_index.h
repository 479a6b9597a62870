#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "core/job/yaml_tree.h"

namespace hyades::core {

/// Where the keys of a map stand in it, for who looks up as many as it has: YamlNode::find() goes
/// through all of them each time. Sorted, not hashed: keys are strangers' words, and some are
/// chosen so that their hashes are equal. The map outlives it.
class KeyIndex {
 public:
  static constexpr size_t kNone = static_cast<size_t>(-1);

  explicit KeyIndex(const YamlNode& node) : map_(node.map), order_(node.map.size()) {
    for (size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(),
              [&](size_t a, size_t b) { return map_[a].key < map_[b].key; });
  }

  /// Index in YamlNode::map; kNone where the map has no such key.
  size_t find(std::string_view key) const {
    const auto found =
        std::lower_bound(order_.begin(), order_.end(), key,
                         [&](size_t i, std::string_view wanted) { return map_[i].key < wanted; });
    return found == order_.end() || map_[*found].key != key ? kNone : *found;
  }
  bool contains(std::string_view key) const { return find(key) != kNone; }

 private:
  const std::vector<YamlEntry>& map_;
  std::vector<size_t> order_;
};

}  // namespace hyades::core
