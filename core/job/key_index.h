#pragma once

#include <cstddef>
#include <string_view>
#include <unordered_map>

#include "core/job/yaml_tree.h"

namespace hyades::core {

/// Where the keys of a map stand in it, for who looks up as many as it has: YamlNode::find() goes
/// through all of them each time. The map outlives it.
class KeyIndex {
 public:
  static constexpr size_t kNone = static_cast<size_t>(-1);

  explicit KeyIndex(const YamlNode& node) {
    places_.reserve(node.map.size());
    for (size_t i = 0; i < node.map.size(); ++i) places_[node.map[i].key] = i;
  }

  /// Index in YamlNode::map; kNone where the map has no such key.
  size_t find(std::string_view key) const {
    const auto found = places_.find(key);
    return found == places_.end() ? kNone : found->second;
  }
  bool contains(std::string_view key) const { return find(key) != kNone; }

 private:
  std::unordered_map<std::string_view, size_t> places_;
};

}  // namespace hyades::core
