#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/job/yaml_tree.h"

/// Trees of YAML made here instead of read: what importers say of a scene.
namespace hyades::core {

/// Any text; written in quotes where it would read as anything else.
YamlPtr yaml_text(std::string text);

/// A word of the job language or an expression: never in quotes.
YamlPtr yaml_word(std::string word);

/// The shortest number that reads back as the same float. It must be finite.
YamlPtr yaml_number(float number);
YamlPtr yaml_integer(int64_t number);
YamlPtr yaml_flag(bool flag);

YamlPtr yaml_list(std::vector<YamlPtr> items);
YamlPtr yaml_numbers(std::span<const float> numbers);
YamlPtr yaml_vector(const Vec3& vector);  ///< or a colour: [r, g, b]

/// A map in the making; keys are written in the order in which they are put.
class YamlMap {
 public:
  YamlMap() { map_.kind = YamlNode::Kind::map; }
  YamlMap(std::initializer_list<std::pair<std::string_view, YamlPtr>> entries);

  /// The key must not be there yet.
  YamlMap& put(std::string_view key, YamlPtr value);
  YamlMap& put(std::string_view key, const YamlMap& value) { return put(key, value.node()); }

  bool has(std::string_view key) const { return map_.find(key) != nullptr; }
  bool empty() const { return map_.map.empty(); }
  YamlPtr node() const;  ///< a copy: the map may go on

 private:
  YamlNode map_;
};

}  // namespace hyades::core
