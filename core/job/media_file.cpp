#include "core/job/media_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "core/job/join_trees.h"

namespace hyades::core {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kOtherNames = {{
    {"sigma_a", "absorption"},
    {"sigma_s", "scattering"},
    {"ior", "index"},
}};

bool is_json(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
}

/// JSON may be indented with tabs, which YAML refuses; within its texts there are none.
std::string without_tabs(std::string_view text) {
  std::string result(text);
  std::replace(result.begin(), result.end(), '\t', ' ');
  return result;
}

/// The keys of one medium in the words of a job.
YamlPtr in_our_words(const YamlNode& medium, Diagnostics& diagnostics) {
  auto result = std::make_shared<YamlNode>(medium);
  result->map.clear();
  std::set<std::string> keys;
  for (const YamlEntry& entry : medium.map) {
    if (entry.key == "name") continue;
    YamlEntry renamed = entry;
    for (const auto& [other, ours] : kOtherNames) {
      if (entry.key == other) renamed.key = ours;
    }
    if (!keys.insert(renamed.key).second) {
      diagnostics.add(entry.key_where,
                      "there is another key that means " + renamed.key + ", expected one");
      continue;
    }
    result->map.push_back(std::move(renamed));
  }
  return result;
}

/// Adds a medium that carries its name; false after a complaint.
bool add_named(const YamlNode& medium, JoinedSection& media, Diagnostics& diagnostics) {
  const YamlEntry* name = medium.find("name");
  if (name == nullptr || name->value->kind != YamlNode::Kind::scalar) {
    diagnostics.add(medium.where, "a medium is " + describe(medium) +
                                      ", expected a map with a name, such as {\"name\": \"milk\", "
                                      "\"absorption\": [...], \"scattering\": [...]}");
    return false;
  }
  if (media.find(name->value->scalar) != nullptr) {
    diagnostics.add(name->key_where, "there is another medium '" + name->value->scalar + "'");
    return false;
  }
  media.add({name->value->scalar, name->value->where, in_our_words(medium, diagnostics)});
  return true;
}

}  // namespace

YamlPtr read_media_file(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  YamlPtr root = parse_yaml(is_json(text) ? without_tabs(text) : text, file, diagnostics);
  if (root == nullptr) return nullptr;
  if (const YamlEntry* section = root->find("media")) root = section->value;
  YamlNode none = empty_map();
  none.where = root->where;
  none.weight = root->weight;
  JoinedSection media(none);
  bool good = true;
  if (root->kind == YamlNode::Kind::list) {
    for (const YamlPtr& medium : root->list) good &= add_named(*medium, media, diagnostics);
  } else if (root->find("name") != nullptr) {
    good = add_named(*root, media, diagnostics);
  } else if (root->kind == YamlNode::Kind::map) {
    for (const YamlEntry& entry : root->map) {
      YamlEntry renamed = entry;
      if (entry.value->kind == YamlNode::Kind::map) {
        renamed.value = in_our_words(*entry.value, diagnostics);
      }
      media.add(renamed);
    }
  } else {
    diagnostics.add(root->where, "the file of media holds " + describe(*root) +
                                     ", expected a medium or a list of them");
    return nullptr;
  }
  return good ? media.map() : nullptr;
}

}  // namespace hyades::core
