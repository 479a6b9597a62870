#include "import/fill_with_media.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/base/text.h"
#include "core/job/parse.h"
#include "core/job/yaml_build.h"

namespace hyades::core {

namespace {

/// The media of a file: whether each has an index of refraction.
Result<std::map<std::string, bool>> read_media(const std::string& file, AssetResolver& files) {
  if (const auto bytes = files.open(file); !bytes) return bytes.error();
  Diagnostics diagnostics;
  const std::string text = "hyades: 1\nmedia: {file: " + nlohmann::json(file).dump() + "}\n";
  const Job job = parse_job(text, "", files, diagnostics);
  if (!diagnostics.empty()) return diagnostics.to_error();
  std::map<std::string, bool> media;
  for (const MediumDesc& medium : job.media) media[medium.name] = medium.index.has_value();
  if (media.empty()) return Error{file + ": there is no medium in it"};
  return media;
}

template <class Names>
std::string listed(const Names& names) {
  constexpr size_t kMost = 12;
  std::vector<std::string> some;
  for (const auto& name : names) {
    if (some.size() < kMost) some.push_back(name);
  }
  if (names.size() > kMost)
    return "'" + some.front() + "' and " + std::to_string(names.size() - 1) + " more";
  return join_names(some);
}

std::string text_at(const YamlNode& object, const char* key) {
  const YamlEntry* entry = object.find(key);
  return entry != nullptr ? entry->value->scalar : std::string();
}

bool is_glass(const YamlNode* materials, const std::string& name) {
  const YamlEntry* material = materials != nullptr ? materials->find(name) : nullptr;
  return material != nullptr && text_at(*material->value, "type") == "dielectric";
}

/// Section `key` of a tree; an empty map where there is none.
const YamlNode& section(const YamlNode& tree, const char* key) {
  const YamlEntry* entry = tree.find(key);
  return entry != nullptr ? *entry->value : empty_map();
}

/// How many objects there are that are not copies of others.
size_t count_things(const YamlNode& sections) {
  const auto count = [](const YamlNode& objects) {
    return static_cast<size_t>(std::count_if(
        objects.map.begin(), objects.map.end(),
        [](const YamlEntry& entry) { return entry.value->find("instance") == nullptr; }));
  };
  size_t things = count(section(sections, "objects"));
  for (const YamlEntry& group : section(sections, "groups").map) {
    things += count(section(*group.value, "objects"));
  }
  return things;
}

}  // namespace

Result<YamlPtr> fill_with_media(const YamlNode& sections, const MediaFile& media,
                                const std::string& scene, AssetResolver& files) {
  const auto known = read_media(media.reference, files);
  if (!known) return known.error();
  const YamlEntry* materials = sections.find("materials");
  std::vector<std::string> called;
  std::set<std::string> clear;  // materials that let everything through
  YamlMap looks;
  bool bound = false;
  std::set<std::string> unused;
  const bool only_one = known->size() == 1 && count_things(sections) == 1;
  const auto fill = [&](const YamlNode& all) {
    YamlMap filled;
    for (const YamlEntry& entry : all.map) {
      const YamlNode& object = *entry.value;
      if (object.find("instance") != nullptr) {
        filled.put(entry.key, entry.value);
        continue;
      }
      const std::string material = text_at(object, "material");
      const std::string part = object.find("part") != nullptr ? text_at(object, "part") : material;
      called.push_back(part);
      const auto named = known->contains(part) ? known->find(part) : known->find(material);
      const auto medium = named == known->end() && only_one ? known->begin() : named;
      if (medium == known->end()) {
        filled.put(entry.key, entry.value);
        continue;
      }
      bound = true;
      YamlMap own;
      for (const YamlEntry& key : object.map) {
        if (key.key == "interior") continue;
        if (key.key == "material" && medium->second) {
          unused.insert(material);
          continue;
        }
        own.put(key.key, key.value);
      }
      if (!medium->second &&
          !is_glass(materials != nullptr ? materials->value.get() : nullptr, material))
        clear.insert(material);
      own.put("interior", yaml_text(medium->first));
      filled.put(entry.key, own);
    }
    return filled;
  };
  const YamlMap filled = fill(section(sections, "objects"));
  YamlMap groups;
  for (const YamlEntry& group : section(sections, "groups").map) {
    groups.put(group.key, YamlMap{{"objects", fill(section(*group.value, "objects")).node()}});
  }
  if (!bound) {
    std::vector<std::string> names;
    for (const auto& [name, has_index] : *known) names.push_back(name);
    return Error{media.reference + ": none of its media (" + listed(names) +
                 ") has the name of a material of " + scene + " (" + listed(called) + ")"};
  }
  if (materials != nullptr) {
    for (const YamlEntry& entry : materials->value->map) {
      if (unused.contains(entry.key)) continue;
      const YamlMap none{{"type", yaml_text("null")}};
      looks.put(entry.key, clear.contains(entry.key) ? none.node() : entry.value);
    }
  }
  YamlMap result;
  YamlMap all_media{{"file", yaml_text(media.in_job)}};
  for (const YamlEntry& own : section(sections, "media").map) {
    if (!known->contains(own.key)) all_media.put(own.key, own.value);
  }
  result.put("media", all_media);
  for (const YamlEntry& section : sections.map) {
    if (section.key == "objects") {
      result.put("objects", filled);
    } else if (section.key == "groups") {
      result.put("groups", groups);
    } else if (section.key == "materials") {
      if (!looks.empty()) result.put("materials", looks);
    } else if (section.key != "media") {
      result.put(section.key, section.value);
    }
  }
  return result.node();
}

}  // namespace hyades::core
