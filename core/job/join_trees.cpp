#include "core/job/join_trees.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "core/job/key_index.h"

namespace hyades::core {

namespace {

constexpr std::array<std::string_view, 6> kNamed = {"textures", "materials", "media",
                                                    "groups",   "objects",   "lights"};
constexpr std::array<std::string_view, 6> kSections = {"frames",     "film",   "sampling",
                                                       "integrator", "camera", "environment"};

template <class Names>
bool contains(const Names& names, std::string_view key) {
  return std::find(names.begin(), names.end(), key) != names.end();
}

std::string place_of(const YamlPlace& place) {
  const SourceLocation where = place;
  return where.file + ":" + std::to_string(where.line);
}

void complain_twice(const YamlEntry& first, const YamlEntry& second, Diagnostics& diagnostics) {
  diagnostics.add(second.key_where, "'" + second.key.substr(0, 60) + "' is also at " +
                                        place_of(first.key_where) +
                                        "; expected it in one file only");
}

}  // namespace

bool is_named_section(std::string_view key) { return contains(kNamed, key); }

YamlPtr join_section(const YamlNode& upper, const YamlNode& lower, bool overrides,
                     Diagnostics& diagnostics) {
  auto result = std::make_shared<YamlNode>(upper);
  const KeyIndex index(upper);
  for (const YamlEntry& entry : lower.map) {
    const size_t own = index.find(entry.key);
    if (own == KeyIndex::kNone) {
      result->map.push_back(entry);
    } else if (!overrides) {
      complain_twice(upper.map[own], entry, diagnostics);
    }
  }
  return result;
}

YamlPtr join_files(const YamlNode& upper, const YamlNode& lower, bool overrides,
                   Diagnostics& diagnostics) {
  auto result = std::make_shared<YamlNode>(upper);
  const KeyIndex index(upper);
  for (const YamlEntry& entry : lower.map) {
    if (entry.key == "include") continue;
    const size_t place = index.find(entry.key);
    if (place == KeyIndex::kNone) {
      result->map.push_back(entry);
      continue;
    }
    YamlEntry* const own = &result->map[place];
    const bool maps =
        own->value->kind == YamlNode::Kind::map && entry.value->kind == YamlNode::Kind::map;
    if (maps && is_named_section(entry.key)) {
      own->value = join_section(*own->value, *entry.value, false, diagnostics);
    } else if (maps && contains(kSections, entry.key)) {
      own->value = join_section(*own->value, *entry.value, overrides, diagnostics);
    } else if (!overrides && entry.key != "hyades") {
      complain_twice(*own, entry, diagnostics);
    }
  }
  return result;
}

}  // namespace hyades::core
