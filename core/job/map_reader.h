#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/text.h"
#include "core/job/key_index.h"
#include "core/job/kinds_of.h"
#include "core/job/read_context.h"

namespace hyades::core {

class MapReader;

template <class Desc>
void read_fields(MapReader& reader, Desc& desc);

/// Reads a map key by key. Each reader asks for the keys that it understands, with type, range and
/// a target that already holds the default; finish() then complains about keys that nobody asked
/// for. Complaints name the key, what was found and what was expected; a bad value leaves its
/// target as it was.
class MapReader {
 public:
  /// `map` must outlive the reader. `what` names it in complaints ("the camera", "material
  /// 'glass'"); `path` is where it stands ("materials.glass"); `section` is its place in the
  /// reference (JobKey). Complains where `map` is no map.
  MapReader(ReadContext& context, const YamlNode& map, std::string what, std::string path,
            std::string section);

  ReadContext& context() { return context_; }
  bool listing() const { return context_.listing != nullptr; }
  const YamlNode& node() const { return map_; }
  const std::string& what() const { return what_; }
  const std::string& path() const { return path_; }
  const SourceLocation& where() const { return where_; }

  /// From here on, keys asked for belong to this section of the reference.
  void enter_section(std::string section) { section_ = std::move(section); }
  /// As enter_section, and they are those of this type; for listings of keys.
  void enter_type(const std::string& type) { section_ = type_ = type; }
  /// What `key` takes, where keys are listed (listing()); most calls below say it themselves.
  void tell(std::string_view key, KeyFacts facts);

  /// `key` is known, but somebody else reads it.
  void leave_to_others(std::string_view key) { ask(key); }

  /// The value of `key`, or null where it is absent (or empty, which is a complaint).
  const YamlNode* find(std::string_view key);
  /// Whether `key` is there with a value.
  bool has(std::string_view key) const;
  /// What is written as a key with its value, the space after the colon forgotten; empty: nothing.
  std::string key_without_space() const;
  /// Whether a key that was asked for is there without a value, which has been complained about.
  bool has_empty() const { return has_empty_; }
  /// Where the value of `key`, which is there, stands.
  SourceLocation where_of(std::string_view key) const { return map_.find(key)->value->where; }
  /// Complains unless `key` is there.
  void require(std::string_view key, std::string_view expected);

  void number(std::string_view key, float& target, const Range& range);
  void integer(std::string_view key, int32_t& target, int64_t low, int64_t high);
  void integer(std::string_view key, uint32_t& target, int64_t low, int64_t high);
  void integer(std::string_view key, uint64_t& target);
  void flag(std::string_view key, bool& target);
  void text(std::string_view key, std::string& target, std::string_view expected);
  void choice(std::string_view key, std::string& target, std::span<const std::string> names);
  /// An enum whose values are the places among `names`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(std::string_view key, Enum& target, std::span<const std::string> names) {
    std::string name = names[static_cast<size_t>(target)];
    choice(key, name, names);
    target = static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  /// One of `names` for both, or a list of two.
  void choices(std::string_view key, std::string& first, const char* second_line,
               std::string& second, std::span<const std::string> names);
  /// The name of something that the job defines; that it exists is checked at the end.
  void name_of(std::string_view key, std::string& target, NameKind kind);
  /// A list of such names, which may be empty; of objects also what is in them ("tree/trunk", of
  /// which what stands before the first slash is checked); `target` stays empty where the key is
  /// absent.
  void names_of(std::string_view key, std::optional<std::vector<std::string>>& target,
                NameKind kind);
  /// The name of a texture, or one written in place. It must be there.
  void texture(std::string_view key, std::string& target);
  /// A file, relative to where it is written; that it opens is checked at the end.
  void file(std::string_view key, std::string& target);
  /// A file, or one for each frame, of which a frame looks at `files`, relative to where it is
  /// written; that they open is checked at the end.
  void frame_file(std::string_view key, std::string& target, FrameFiles files);
  /// A list of exactly as many numbers as `target` has.
  bool numbers(std::string_view key, std::span<float> target, const Range& range);
  bool integers(std::string_view key, std::span<int32_t> target, int64_t low, int64_t high);
  /// A list of two whole numbers.
  void integers(std::string_view key, const char* a_line, int32_t& a, const char* b_line,
                int32_t& b, int64_t low, int64_t high);
  /// What `target` is where the key that follows is absent; it depends on keys before.
  void starts_at(float& target, float start) { target = start; }
  /// The pixels to render, all of them within the film.
  void crop(std::string_view key, FilmDesc& film);
  /// A distance or the name of an object.
  void focus(std::string_view key, std::optional<Animated<float>>& distance, std::string& object,
             SourceLocation& where);

  void animated(std::string_view key, Animated<float>& target, const Range& range);
  void animated(std::string_view key, Animated<Vec2>& target, const Range& range);
  void animated(std::string_view key, Animated<Vec3>& target, const Range& range);
  /// A number or vector that may move; `target` stays empty where the key is absent.
  template <class T>
  void animated(std::string_view key, std::optional<Animated<T>>& target, const Range& range) {
    Animated<T> value;
    animated(key, value, range);
    forget_start(key);
    if (has(key)) target = value;
  }
  /// A vector that may move; complains where it is [0, 0, 0] at a frame.
  void direction(std::string_view key, Animated<Vec3>& target);
  void direction(std::string_view key, std::optional<Animated<Vec3>>& target);
  /// Complains where two points that were read already are the same at a frame.
  void keep_apart(std::string_view a_key, const Animated<Vec3>& a, std::string_view b_key,
                  const Animated<Vec3>& b);
  /// The `transform` and `at` of what may move while the shutter is open.
  void place(TransformList& steps, Animated<Vec3>& at);
  /// A list of steps, of what stands still while the shutter is open.
  void transform(std::string_view key, TransformList& target);
  /// A name of letters, digits, _ and -, for it becomes part of channels' names.
  void light_group(std::string_view key, std::string& target);
  /// A rotation as a quaternion.
  void rotation(std::string_view key, Animated<Vec4>& target);
  /// A vector; a single number stands for all three, and [x, y] leaves z as it is.
  void animated_scale(std::string_view key, Animated<Vec3>& target, const Range& range);
  void color(std::string_view key, Animated<Rgb>& target, const Range& range);
  /// A colour that may move; `target` stays empty where the key is absent.
  void color(std::string_view key, std::optional<Animated<Rgb>>& target, const Range& range);
  void color_input(std::string_view key, ColorInput& target, const Range& range);
  void color_input(std::string_view key, std::optional<ColorInput>& target, const Range& range);
  void scalar_input(std::string_view key, ScalarInput& target, const Range& range);
  void scalar_input(std::string_view key, std::optional<ScalarInput>& target, const Range& range);

  /// A map below this one. In listing mode the reader runs even where the key is absent.
  void map(std::string_view key, const std::string& section,
           const std::function<void(MapReader&)>& read);
  /// The keys of a description, which stays empty where `key` is absent.
  template <class Desc>
  void map(std::string_view key, const std::string& section, std::optional<Desc>& desc) {
    if (has(key) || listing()) desc.emplace();
    map(key, section, [&](MapReader& inner) {
      if constexpr (requires { desc->where; }) desc->where = inner.where();
      read_fields(inner, *desc);
    });
  }

  /// The keys of a description that is there in any case.
  template <class Desc>
  requires std::is_class_v<Desc> && requires(Desc& desc, MapReader& reader) {
    Desc::fields(desc, reader);
  }
  void map(std::string_view key, const std::string& section, Desc& desc) {
    map(key, section, [&](MapReader& inner) { read_fields(inner, desc); });
  }

  /// As map(), but where the value is no map (or one of keys over time) it is another member's.
  template <class Desc>
  void map_beside_value(std::string_view key, const std::string& section,
                        std::optional<Desc>& desc) {
    if (is_map_of_keys(find(key)) || listing()) map(key, section, desc);
    if (listing()) tell(key, {.takes = "colour or map", .below = section});
  }
  /// A map, or in its place desc.color alone.
  template <class Desc>
  void color_or_map(std::string_view key, const std::string& section, std::optional<Desc>& desc,
                    const Range& range) {
    if (is_map_of_keys(find_color(key)) || listing()) {
      map(key, section, desc);
      if (listing()) tell(key, {.takes = "colour or map", .range = range, .below = section});
      return;
    }
    Animated<Rgb> value(Rgb(0.0F));
    color(key, value, range);
    if (!has(key)) return;
    desc.emplace();
    desc->color = value;
  }
  /// A map, or in its place desc.type alone.
  template <class Desc>
  void type_or_map(std::string_view key, const std::string& section, Desc& desc,
                   std::span<const std::string> types) {
    const YamlNode* node = find(key);
    const bool is_map = node != nullptr && node->kind == YamlNode::Kind::map;
    if (is_map || listing()) map(key, section, desc);
    if (listing())
      tell(key, {.takes = "type or map", .names = {types.begin(), types.end()}, .below = section});
    if (is_map || node == nullptr) return;
    choice(key, desc.type, types);
    MapReader inner(context_, empty_map(), what_, path_, section);
    read_fields(inner, desc);
  }
  /// Numbers and the colours that stand there.
  void stops(std::string_view key, std::vector<textures::Stop>& stops);
  /// One number by either of two keys; `unit` becomes 0 or 1.
  template <class Unit>
  void either(std::string_view a_key, const Range& a_range, std::string_view b_key,
              const Range& b_range, Unit& unit, Animated<float>& value) {
    animated(a_key, value, a_range);
    animated(b_key, value, b_range);
    forget_start(b_key);
    if (has(b_key)) unit = static_cast<Unit>(1);
  }
  /// Materials and those that stand in for them; both may be new ones.
  void overrides(std::string_view key, std::vector<std::pair<std::string, std::string>>& overrides);
  /// The objects of a group that is written in place.
  void children(std::string_view key, std::vector<ObjectDesc>& children);
  /// What a measured medium brings.
  void preset(std::string_view key, MediumDesc& medium);

  /// Complains about the value of `key`: "fov is 'wide', expected ...".
  void mismatch(std::string_view key, const YamlNode& found, const std::string& expected);
  void complain(const SourceLocation& where, const std::string& message) {
    context_.complain(where, message);
  }

  /// Complains about every key that nobody asked for.
  void finish();

 private:
  /// Whether it is a map, but not one of values over time.
  static bool is_map_of_keys(const YamlNode* node);
  void ask(std::string_view key);
  /// Where keys are listed only: `key` may be absent.
  void forget_start(std::string_view key);
  const YamlNode* find(std::string_view key, std::string_view hint);
  const YamlEntry* entry_of(std::string_view key);
  /// Finds the node of a colour; where it is empty, the complaint tells of the commonest reason.
  const YamlNode* find_color(std::string_view key);

  /// Notes a value that was read as a curve of the job.
  template <class T>
  void note(std::string_view key, const Animated<T>& value) {
    const std::string path = path_.empty() ? std::string(key) : path_ + "." + std::string(key);
    context_.job.curves.push_back({path, value});
  }

  ReadContext& context_;
  const YamlNode& map_;
  std::string what_;
  std::string path_;
  std::string section_;
  std::string type_;  ///< the type whose keys are read; where none is told apart, the section
  SourceLocation where_;
  std::vector<std::string> asked_;
  std::optional<KeyIndex> index_;  ///< of maps with many keys
  bool has_empty_ = false;
};

/// What the keys of a description ask of each other, beyond what each takes, where none is empty.
/// Most ask nothing; for the others there are overloads, which complain.
template <class Desc>
void check_keys(MapReader& /*reader*/, Desc& /*desc*/) {}

/// Reads the keys of `desc`.
template <class Desc>
void read_fields(MapReader& reader, Desc& desc) {
  Desc::fields(desc, reader);
  if (!reader.listing() && !reader.has_empty()) check_keys(reader, desc);
}

/// Reads `key` as one of `names` into `type` (which holds the default, "" = required) and lets
/// `read` read the rest, in section "section.type"; it is given the place among `names`. False
/// where the type is unknown.
bool read_by_type(MapReader& reader, std::string_view key, const std::string& section,
                  std::string& type, std::span<const std::string> names,
                  const std::function<void(size_t)>& read);

/// Reads `type` into desc.type, and then the keys of `desc`, from section "section.type" on.
template <class Desc>
void read_typed(MapReader& reader, const std::string& section, Desc& desc,
                std::span<const std::string> types) {
  read_by_type(reader, "type", section, desc.type, types, [&](size_t type) {
    desc.type = types[type];
    read_fields(reader, desc);
  });
}

/// Reads `type` into desc.kind, a variant (KindsOf), and then all keys of `desc`, from section
/// "section.type" on. False where the type is unknown.
template <class Desc>
bool read_kind(MapReader& reader, const std::string& section, Desc& desc) {
  using Kinds = KindsOf<decltype(desc.kind)>;
  std::string type;
  return read_by_type(reader, "type", section, type, Kinds::names(), [&](size_t kind) {
    desc.kind = Kinds::make(kind);
    Desc::fields(desc, reader);
    if (reader.listing() || reader.has_empty()) return;
    std::visit([&](auto& of_type) { check_keys(reader, of_type); }, desc.kind);
  });
}

}  // namespace hyades::core
