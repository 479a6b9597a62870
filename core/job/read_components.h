#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/job/expression.h"
#include "core/job/map_reader.h"
#include "core/job/read_values.h"

/// The parts that animated numbers, vectors and colours have in common.
namespace hyades::core {

/// A number (into `constant`) or "= expression".
bool read_component(const ValueSite& site, const YamlNode& node, float& constant,
                    std::shared_ptr<const Expression>& expression);

/// The `ease` of {keys: ..., ease: ...}.
Ease read_ease(MapReader& reader);

/// The `repeat` of the same.
Repeat read_repeat(MapReader& reader);

/// Reads {keys: {frame: value, ...}, ease: name, repeat: name}; `read` reads one value.
template <class T, class Read>
bool read_keys(const ValueSite& site, const YamlNode& node, Animated<T>& target, Read read) {
  MapReader reader(site.context, node, site.label, site.label, "animation");
  reader.require("keys", "a map of frame numbers to values");
  const YamlNode* keys = reader.find("keys");
  Animated<T> result;
  result.ease = read_ease(reader);
  result.repeat = read_repeat(reader);
  reader.finish();
  if (keys == nullptr) return false;
  if (keys->kind != YamlNode::Kind::map || keys->map.empty()) {
    const ValueSite keys_site{site.context, "keys of " + site.label, {}};
    complain_mismatch(keys_site, *keys, "a map of frame numbers to values, such as {1: 0, 120: 1}");
    return false;
  }
  if (!site.context.spend(keys->map.size(), keys->where)) return false;
  bool good = true;
  for (const YamlEntry& entry : keys->map) {
    double frame = 0.0;
    if (!parse_number(entry.key, frame) || frame < -1e6 || frame > 1e7) {
      site.context.complain(
          entry.key_where,
          site.label + " has a key at '" + entry.key.substr(0, 60) + "', expected a frame number");
      good = false;
      continue;
    }
    Animated<T> value = target;
    value.keys.clear();
    value.expressions.fill(nullptr);
    std::vector<NumberCheck>& checks = site.context.job.checks.numbers;
    const size_t checked = checks.size();
    const bool readable = read(site, *entry.value, value);
    checks.resize(checked);
    if (!readable) {
      good = false;
    } else if (!value.is_constant()) {
      site.context.complain(entry.value->where,
                            site.label + " has an expression in a key; keys hold plain values");
      good = false;
    } else {
      result.keys.push_back({frame, value.constant});
    }
  }
  std::sort(result.keys.begin(), result.keys.end(),
            [](const Key<T>& a, const Key<T>& b) { return a.frame < b.frame; });
  for (size_t i = 1; i < result.keys.size(); ++i) {
    if (result.keys[i].frame == result.keys[i - 1].frame) {
      site.context.complain(keys->where, site.label + " has two keys at one frame");
      good = false;
      break;
    }
  }
  if (!good) return false;
  result.constant = result.keys.front().value;
  target = std::move(result);
  return true;
}

/// A plain value or expressions (`read`), or keys of them.
template <class T, class Read>
bool read_animated(const ValueSite& site, const YamlNode& node, Animated<T>& target, Read read) {
  if (node.kind == YamlNode::Kind::map) return read_keys<T>(site, node, target, read);
  return read(site, node, target);
}

}  // namespace hyades::core
