#include "core/job/join_trees.h"

#include <algorithm>
#include <array>

namespace hyades::core {

namespace {

constexpr std::array<std::string_view, 6> kNamed = {"textures", "materials", "media",
                                                    "groups",   "objects",   "lights"};
constexpr std::array<std::string_view, 7> kSections = {
    "frames", "film", "sampling", "integrator", "render", "camera", "environment"};

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

JoinedSection::JoinedSection(const YamlNode& upper) : map_(std::make_shared<YamlNode>(upper)) {
  for (size_t i = 0; i < map_->map.size(); ++i) places_[map_->map[i].key] = i;
}

YamlEntry* JoinedSection::find(const std::string& key) {
  const auto found = places_.find(key);
  return found == places_.end() ? nullptr : &map_->map[found->second];
}

void JoinedSection::add(const YamlEntry& entry) {
  places_[entry.key] = map_->map.size();
  map_->map.push_back(entry);
}

void JoinedSection::add(const YamlNode& lower, bool overrides, Diagnostics& diagnostics) {
  for (const YamlEntry& entry : lower.map) {
    if (const YamlEntry* own = find(entry.key); own == nullptr) {
      add(entry);
    } else if (!overrides) {
      complain_twice(*own, entry, diagnostics);
    }
  }
}

void JoinedFiles::add(const YamlNode& lower, bool overrides, Diagnostics& diagnostics) {
  for (const YamlEntry& entry : lower.map) {
    if (entry.key == "include") continue;
    YamlEntry* const own = files_.find(entry.key);
    if (own == nullptr) {
      files_.add(entry);
      continue;
    }
    const bool named = is_named_section(entry.key);
    const bool maps =
        own->value->kind == YamlNode::Kind::map && entry.value->kind == YamlNode::Kind::map;
    if (maps && (named || contains(kSections, entry.key))) {
      JoinedSection& section = sections_.try_emplace(entry.key, *own->value).first->second;
      section.add(*entry.value, overrides && !named, diagnostics);
      own->value = section.map();
    } else if (!overrides && entry.key != "hyades") {
      complain_twice(*own, entry, diagnostics);
    }
  }
}

YamlPtr join_files(const YamlNode& upper, const YamlNode& lower, bool overrides,
                   Diagnostics& diagnostics) {
  JoinedFiles joined(upper);
  joined.add(lower, overrides, diagnostics);
  return joined.map();
}

}  // namespace hyades::core
