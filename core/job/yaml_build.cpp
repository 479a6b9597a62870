#include "core/job/yaml_build.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <utility>

namespace hyades::core {

namespace {

YamlPtr scalar(std::string text, bool quoted) {
  auto node = std::make_shared<YamlNode>();
  node->kind = YamlNode::Kind::scalar;
  node->quoted = quoted;
  node->scalar = std::move(text);
  return node;
}

}  // namespace

YamlPtr yaml_text(std::string text) { return scalar(std::move(text), true); }

YamlPtr yaml_word(std::string word) { return scalar(std::move(word), false); }

YamlPtr yaml_number(float number) { return scalar(fmt::format("{}", number), false); }

YamlPtr yaml_integer(int64_t number) { return scalar(std::to_string(number), false); }

YamlPtr yaml_flag(bool flag) { return scalar(flag ? "true" : "false", false); }

YamlPtr yaml_list(std::vector<YamlPtr> items) {
  auto node = std::make_shared<YamlNode>();
  node->kind = YamlNode::Kind::list;
  for (const YamlPtr& item : items) node->weight += item->weight;
  node->list = std::move(items);
  return node;
}

YamlPtr yaml_numbers(std::span<const float> numbers) {
  std::vector<YamlPtr> items;
  items.reserve(numbers.size());
  for (const float number : numbers) items.push_back(yaml_number(number));
  return yaml_list(std::move(items));
}

YamlPtr yaml_vector(const Vec3& vector) { return yaml_numbers(std::span(&vector.x, 3)); }

YamlMap::YamlMap(std::initializer_list<std::pair<std::string_view, YamlPtr>> entries) : YamlMap() {
  for (const auto& [key, value] : entries) put(key, value);
}

YamlMap& YamlMap::put(std::string_view key, YamlPtr value) {
  map_.weight += value->weight;
  map_.map.push_back({std::string(key), {}, std::move(value)});
  return *this;
}

YamlPtr YamlMap::node() const { return std::make_shared<YamlNode>(map_); }

}  // namespace hyades::core
