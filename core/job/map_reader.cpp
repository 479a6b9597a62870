#include "core/job/map_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/text.h"
#include "core/job/read_color.h"
#include "core/job/read_textures.h"
#include "core/job/read_values.h"
#include "core/job/suggest.h"

namespace hyades::core {

namespace {

constexpr size_t kFewKeys = 64;  ///< among which a key is looked up one by one

/// Sections in which a key means something, where it means nothing here: "materials.conductor"
/// for `roughness` in a lambert.
std::string belongs_elsewhere(const std::string& section, const std::string& key) {
  static const std::set<JobKey> known = known_job_keys();
  const std::string family = section.substr(0, section.find('.')) + ".";
  std::vector<std::string> types;
  for (const JobKey& k : known) {
    if (k.key == key && k.section.starts_with(family) && k.section != section) {
      types.push_back(k.section.substr(family.size()));
    }
  }
  // Not types: the sections of what all have but null, and all but null and black.
  std::replace(types.begin(), types.end(), std::string("solids"),
               std::string("all materials but null"));
  std::replace(types.begin(), types.end(), std::string("surfaces"),
               std::string("materials that have a surface"));
  return types.empty() ? "" : "; it belongs to " + join_names(types);
}

}  // namespace

MapReader::MapReader(ReadContext& context, const YamlNode& map, std::string what, std::string path,
                     std::string section)
    : context_(context),
      map_(map),
      what_(std::move(what)),
      path_(std::move(path)),
      section_(std::move(section)),
      type_(section_),
      where_(map.where) {
  if (map.kind != YamlNode::Kind::map) {
    complain(where_, (what_.empty() ? "the job" : what_) + " is " + describe(map) +
                         ", expected a map of keys and values");
  }
  context_.spend(map.map.size() + 1, where_);
}

void MapReader::ask(std::string_view key) {
  asked_.emplace_back(key);
  if (listing()) context_.listing->at(type_, {section_, std::string(key)});
}

void MapReader::tell(std::string_view key, KeyFacts facts) {
  KeyFacts& known = context_.listing->at(type_, {section_, std::string(key)});
  facts.required |= known.required;
  known = std::move(facts);
}

void MapReader::forget_start(std::string_view key) {
  if (listing()) context_.listing->at(type_, {section_, std::string(key)}).start.clear();
}

const YamlNode* MapReader::find(std::string_view key) { return find(key, ""); }

const YamlNode* MapReader::find_color(std::string_view key) {
  return find(key,
              " (a colour such as \"#d8c8a8\" needs its quotes: an unquoted # starts a comment)");
}

const YamlEntry* MapReader::entry_of(std::string_view key) {
  if (map_.map.size() <= kFewKeys) return map_.find(key);
  if (!index_) index_.emplace(map_);
  const size_t at = index_->find(key);
  return at == KeyIndex::kNone ? nullptr : &map_.map[at];
}

const YamlNode* MapReader::find(std::string_view key, std::string_view hint) {
  ask(key);
  const YamlEntry* entry = entry_of(key);
  if (entry == nullptr) return nullptr;
  if (entry->value->kind == YamlNode::Kind::null) {
    has_empty_ = true;
    complain(entry->key_where, fmt::format("{} is empty, expected a value{}", key, hint));
    return nullptr;
  }
  // Aliases and `like` read a text again and again, and each time it is copied.
  const uint64_t more = weight_of_text(entry->value->scalar.size()) - 1;
  if (more > 0 && !context_.spend(more, entry->value->where)) return nullptr;
  return entry->value.get();
}

bool MapReader::has(std::string_view key) const {
  const YamlEntry* entry = map_.find(key);
  return entry != nullptr && entry->value->kind != YamlNode::Kind::null;
}

std::string MapReader::key_without_space() const {
  const auto found = std::find_if(map_.map.begin(), map_.map.end(), [](const YamlEntry& entry) {
    return entry.key.find(':') != std::string::npos && entry.value->kind == YamlNode::Kind::null;
  });
  return found != map_.map.end() ? found->key : "";
}

void MapReader::require(std::string_view key, std::string_view expected) {
  if (listing()) context_.listing->at(type_, {section_, std::string(key)}).required = true;
  if (map_.find(key) != nullptr || listing() || map_.kind != YamlNode::Kind::map) return;
  complain(where_, fmt::format("{} has no '{}', expected {}", what_.empty() ? "the job" : what_,
                               key, expected));
}

void MapReader::number(std::string_view key, float& target, const Range& range) {
  if (listing()) tell(key, {.takes = "number", .start = json_of(target), .range = range});
  if (const YamlNode* node = find(key))
    read_number({context_, std::string(key), range}, *node, target);
}

void MapReader::integer(std::string_view key, int32_t& target, int64_t low, int64_t high) {
  if (listing())
    tell(key, {.takes = "whole number",
               .start = std::to_string(target),
               .range = {double(low), double(high)}});
  int64_t value = 0;
  const YamlNode* node = find(key);
  if (node != nullptr && read_integer({context_, std::string(key), {}}, *node, low, high, value)) {
    target = static_cast<int32_t>(value);
  }
}

void MapReader::integer(std::string_view key, uint32_t& target, int64_t low, int64_t high) {
  if (listing())
    tell(key, {.takes = "whole number",
               .start = std::to_string(target),
               .range = {double(low), double(high)}});
  int64_t value = 0;
  const YamlNode* node = find(key);
  if (node != nullptr && read_integer({context_, std::string(key), {}}, *node, low, high, value)) {
    target = static_cast<uint32_t>(value);
  }
}

void MapReader::integer(std::string_view key, uint64_t& target) {
  if (listing())
    tell(key, {.takes = "whole number",
               .start = std::to_string(target),
               .range = {0.0, 0x1p64, false, true}});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  uint64_t value = 0;
  const std::string& text = node->scalar;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (node->kind == YamlNode::Kind::scalar && !node->quoted && result.ec == std::errc{} &&
      result.ptr == text.data() + text.size()) {
    target = value;
  } else {
    mismatch(key, *node, "a whole number from 0 to 18446744073709551615");
  }
}

void MapReader::flag(std::string_view key, bool& target) {
  if (listing()) tell(key, {.takes = "switch", .start = json_of(target)});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind == YamlNode::Kind::scalar && !node->quoted &&
      (node->scalar == "true" || node->scalar == "false")) {
    target = node->scalar == "true";
  } else {
    mismatch(key, *node, "true or false");
  }
}

void MapReader::text(std::string_view key, std::string& target, std::string_view expected) {
  if (listing()) tell(key, {.takes = "text", .start = json_of(target)});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind == YamlNode::Kind::scalar && node->scalar.find('\n') != std::string::npos) {
    mismatch(key, *node, std::string(expected) + " on one line");
  } else if (node->kind == YamlNode::Kind::scalar && !node->scalar.empty()) {
    target = node->scalar;
  } else {
    mismatch(key, *node, std::string(expected));
  }
}

void MapReader::choice(std::string_view key, std::string& target,
                       std::span<const std::string> names) {
  if (listing())
    tell(key, {.takes = "choice", .start = json_of(target), .names = {names.begin(), names.end()}});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  const bool known = node->kind == YamlNode::Kind::scalar &&
                     std::find(names.begin(), names.end(), node->scalar) != names.end();
  if (known) {
    target = node->scalar;
  } else {
    mismatch(key, *node, join_names(names) + suggest(node->scalar, names));
  }
}

void MapReader::name_of(std::string_view key, std::string& target, NameKind kind) {
  static const char* const kNouns[] = {"a texture's name", "a material's name", "a group's name",
                                       "an object's name", "a medium's name"};
  static const char* const kRooms[] = {"textures", "materials", "groups", "objects", "media"};
  const auto k = static_cast<size_t>(kind);
  const YamlNode* node = find(key);
  if (node != nullptr && node->kind == YamlNode::Kind::map)
    return mismatch(key, *node, fmt::format("{}, which stands in '{}'", kNouns[k], kRooms[k]));
  std::string name;
  text(key, name, kNouns[k]);
  if (listing()) tell(key, {.takes = kNouns[k]});
  if (name.empty()) return;
  target = name;
  const std::string label = what_.empty() ? std::string(key) : fmt::format("{} of {}", key, what_);
  context_.names.push_back({kind, name, where_of(key), label});
}

void MapReader::names_of(std::string_view key, std::optional<std::vector<std::string>>& target,
                         NameKind kind) {
  if (listing()) tell(key, {.takes = "texts"});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  const std::string expected = "a list of names, such as [ball, tree/trunk]";
  // What scripts write for an empty list may be an empty map.
  const bool none = node->kind == YamlNode::Kind::map && node->map.empty();
  if (node->kind != YamlNode::Kind::list && !none) return mismatch(key, *node, expected);
  target.emplace();
  for (const YamlPtr& item : node->list) {
    if (!context_.spend(weight_of_text(item->scalar.size()), item->where)) return;
    if (item->kind != YamlNode::Kind::scalar || item->scalar.empty()) {
      mismatch(key, *item, expected);
      continue;
    }
    target->push_back(item->scalar);
    context_.names.push_back({kind, item->scalar.substr(0, item->scalar.find('/')), item->where,
                              fmt::format("{} of {}", key, what_)});
  }
}

void MapReader::file(std::string_view key, std::string& target) {
  std::string name;
  text(key, name, "a file name");
  if (listing()) tell(key, {.takes = "file"});
  if (name.empty()) return;
  const SourceLocation where = where_of(key);
  if (name.size() > kLongestFileName) {
    return complain(where, fmt::format("{} is a name of {} bytes, expected at most {}", key,
                                       name.size(), kLongestFileName));
  }
  target = context_.job_relative(name, where);
  context_.files.push_back({target, where, fmt::format("{} of {}", key, what_), std::nullopt,
                            context_.origins.script_at(where)});
}

void MapReader::frame_file(std::string_view key, std::string& target, FrameFiles files) {
  const size_t before = context_.files.size();
  file(key, target);
  if (listing()) tell(key, {.takes = "file or sequence"});
  if (context_.files.size() > before) context_.files.back().per_frame = files;
}

bool MapReader::numbers(std::string_view key, std::span<float> target, const Range& range) {
  if (listing()) tell(key, {.takes = fmt::format("{} numbers", target.size()), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return false;
  if (node->kind != YamlNode::Kind::list || node->list.size() != target.size()) {
    mismatch(key, *node, fmt::format("a list of {} numbers", target.size()));
    return false;
  }
  bool good = true;
  for (size_t i = 0; i < target.size(); ++i) {
    const ValueSite item{context_, fmt::format("{}[{}]", key, i), range};
    good &= read_number(item, *node->list[i], target[i]);
  }
  return good;
}

bool MapReader::integers(std::string_view key, std::span<int32_t> target, int64_t low,
                         int64_t high) {
  if (listing())
    tell(key, {.takes = fmt::format("{} whole numbers", target.size()),
               .start = fmt::format("[{}]", fmt::join(target, ", ")),
               .range = {double(low), double(high)}});
  const YamlNode* node = find(key);
  if (node == nullptr) return false;
  if (node->kind != YamlNode::Kind::list || node->list.size() != target.size()) {
    mismatch(key, *node, fmt::format("a list of {} whole numbers", target.size()));
    return false;
  }
  bool good = true;
  for (size_t i = 0; i < target.size(); ++i) {
    const ValueSite item{context_, fmt::format("{}[{}]", key, i), {}};
    int64_t value = 0;
    if (read_integer(item, *node->list[i], low, high, value)) {
      target[i] = static_cast<int32_t>(value);
    } else {
      good = false;
    }
  }
  return good;
}

void MapReader::animated(std::string_view key, Animated<float>& target, const Range& range) {
  if (listing()) tell(key, {.takes = "number, animated", .start = json_of(target), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_animated_number({context_, std::string(key), range}, *node, target)) note(key, target);
}

void MapReader::animated(std::string_view key, Animated<Vec2>& target, const Range& range) {
  if (listing()) tell(key, {.takes = "pair, animated", .start = json_of(target), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_animated_pair({context_, std::string(key), range}, *node, target)) note(key, target);
}

void MapReader::animated(std::string_view key, Animated<Vec3>& target, const Range& range) {
  if (listing()) tell(key, {.takes = "vector, animated", .start = json_of(target), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_animated_vector({context_, std::string(key), range}, *node, target)) note(key, target);
}

void MapReader::direction(std::string_view key, Animated<Vec3>& target) {
  if (listing()) tell(key, {.takes = "vector, animated", .start = json_of(target)});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  const std::string name(key);
  if (!read_animated_vector({context_, name, kAnyNumber}, *node, target)) return;
  note(key, target);
  context_.job.checks.vectors.push_back({target, Animated<Vec3>(Vec3(0.0F)), node->where,
                                         name + " is", "a direction, not [0, 0, 0]",
                                         context_.in_shutter});
}

void MapReader::direction(std::string_view key, std::optional<Animated<Vec3>>& target) {
  Animated<Vec3> value(Vec3(0.0F, 1.0F, 0.0F));
  direction(key, value);
  forget_start(key);
  if (has(key)) target = value;
}

void MapReader::keep_apart(std::string_view a_key, const Animated<Vec3>& a, std::string_view b_key,
                           const Animated<Vec3>& b) {
  const YamlEntry* entry = map_.find(b_key);
  if (entry == nullptr) entry = map_.find(a_key);
  if (entry == nullptr) return;  // defaults are apart
  context_.job.checks.vectors.push_back({a, b, entry->value->where,
                                         fmt::format("{} and {} are both", a_key, b_key),
                                         "two points", context_.in_shutter});
}

void MapReader::rotation(std::string_view key, Animated<Vec4>& target) {
  if (listing()) tell(key, {.takes = "quaternion"});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_animated_rotation({context_, std::string(key), kAnyNumber}, *node, target))
    note(key, target);
}

void MapReader::animated_scale(std::string_view key, Animated<Vec3>& target, const Range& range) {
  if (listing()) tell(key, {.takes = "scale, animated", .start = json_of(target), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_animated_scale({context_, std::string(key), range}, *node, target)) note(key, target);
}

void MapReader::color(std::string_view key, Animated<Rgb>& target, const Range& range) {
  if (listing())
    tell(key,
         {.takes = "colour, animated", .start = json_of_color(target.constant), .range = range});
  const YamlNode* node = find_color(key);
  if (node == nullptr) return;
  if (read_animated_color({context_, std::string(key), range}, *node, target)) note(key, target);
}

void MapReader::color(std::string_view key, std::optional<Animated<Rgb>>& target,
                      const Range& range) {
  if (listing()) tell(key, {.takes = "colour, animated", .range = range});
  if (find(key) == nullptr) return;
  Animated<Rgb> value(Rgb(1.0F));
  color(key, value, range);
  target = value;
}

void MapReader::color_input(std::string_view key, ColorInput& target, const Range& range) {
  if (listing())
    tell(key, {.takes = "colour or texture",
               .start = json_of_color(target.value.constant),
               .range = range});
  const YamlNode* node = find_color(key);
  if (node == nullptr) return;
  if (read_texture_input(*this, key, *node, target.texture)) return;
  if (read_animated_color({context_, std::string(key), range}, *node, target.value)) {
    target.texture.clear();
    note(key, target.value);
  }
}

void MapReader::scalar_input(std::string_view key, ScalarInput& target, const Range& range) {
  if (listing())
    tell(key, {.takes = "number or texture", .start = json_of(target.value), .range = range});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (read_texture_input(*this, key, *node, target.texture)) return;
  if (read_animated_number({context_, std::string(key), range}, *node, target.value)) {
    target.texture.clear();
    note(key, target.value);
  }
}

void MapReader::color_input(std::string_view key, std::optional<ColorInput>& target,
                            const Range& range) {
  ColorInput value;
  color_input(key, value, range);
  forget_start(key);
  if (has(key)) target = value;
}

void MapReader::scalar_input(std::string_view key, std::optional<ScalarInput>& target,
                             const Range& range) {
  ScalarInput value;
  scalar_input(key, value, range);
  forget_start(key);
  if (has(key)) target = value;
}

void MapReader::texture(std::string_view key, std::string& target) {
  const char* const expected = "a texture's name or a texture";
  require(key, expected);
  if (listing()) tell(key, {.takes = "texture"});
  const YamlNode* node = find(key);
  if (node != nullptr && !read_texture_input(*this, key, *node, target)) {
    mismatch(key, *node, expected);
  }
}

void MapReader::map(std::string_view key, const std::string& section,
                    const std::function<void(MapReader&)>& read) {
  if (listing()) tell(key, {.takes = "map", .below = section});
  const YamlNode* node = find(key);
  if (node == nullptr && !listing()) return;
  const std::string name = what_.empty() ? std::string(key) : fmt::format("{} of {}", key, what_);
  const std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  MapReader reader(context_, node != nullptr ? *node : empty_map(), name, path, section);
  if (node != nullptr && node->kind != YamlNode::Kind::map) return;
  read(reader);
  reader.finish();
}

bool MapReader::is_map_of_keys(const YamlNode* node) {
  return node != nullptr && node->kind == YamlNode::Kind::map && node->find("keys") == nullptr;
}

void MapReader::mismatch(std::string_view key, const YamlNode& found, const std::string& expected) {
  complain_mismatch({context_, std::string(key), {}}, found, expected);
}

void MapReader::finish() {
  if (listing()) return;
  std::sort(asked_.begin(), asked_.end());
  asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
  for (const YamlEntry& entry : map_.map) {
    if (std::binary_search(asked_.begin(), asked_.end(), entry.key)) continue;
    if (context_.diagnostics.full()) return;
    std::string hint = other_word(entry.key, asked_);
    if (hint.empty()) hint = belongs_elsewhere(section_, entry.key);
    if (hint.empty()) hint = did_you_mean(entry.key, asked_);
    if (hint.empty()) hint = "; expected " + join_names(asked_);
    complain(entry.key_where, fmt::format("unknown key '{}' in {}{}", entry.key.substr(0, 60),
                                          what_.empty() ? "the job" : what_, hint));
  }
}

bool read_by_type(MapReader& reader, std::string_view key, const std::string& section,
                  std::string& type, std::span<const std::string> names,
                  const std::function<void(size_t)>& read) {
  const std::string expected = "one of " + join_names(names);
  if (type.empty()) reader.require(key, expected);
  if (reader.listing())
    reader.tell(key, {.takes = "choice", .names = {names.begin(), names.end()}});
  const YamlNode* node = reader.find(key);
  if (reader.listing()) {
    for (size_t i = 0; i < names.size(); ++i) {
      reader.enter_type(section + "." + names[i]);
      read(i);
    }
    return true;
  }
  if (node != nullptr) reader.text(key, type, expected);
  if (type.empty()) return false;
  const auto found = std::find(names.begin(), names.end(), type);
  if (found == names.end()) {
    reader.complain(node != nullptr ? SourceLocation(node->where) : reader.where(),
                    fmt::format("{} is '{}', expected {}{}", key, type.substr(0, 60),
                                join_names(names), suggest(type, names)));
    return false;
  }
  reader.enter_section(section + "." + type);
  read(static_cast<size_t>(found - names.begin()));
  return true;
}

}  // namespace hyades::core
