#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/job/inputs.h"
#include "core/job/source.h"
#include "core/job/transform_desc.h"
#include "core/job/value_checks.h"

/// What a job is described by states its keys once, in
///
///   template <class Self, class Visitor>
///   static void fields(Self& self, Visitor& visit) {
///     visit.color_input("color", self.color, kUnitInterval);
///     ...
///   }
///
/// Defaults are those of the members. All that is done with keys follows from this list: MapReader
/// reads them, FieldWriter writes the render key, references.h collects names and files.
/// What no list names cannot be read; so no key that is read can be missing from the render key.
namespace hyades::core {

/// What a name in a job may stand for.
enum class NameKind { texture, material, group, object, medium };

/// The name of a key.
struct KeyName {
  // NOLINTNEXTLINE(google-explicit-constructor): a plain name
  KeyName(const char* of_key) : name(of_key), line(of_key) {}
  /// One that has another name in the lines of the render key, which stay as they are.
  KeyName(std::string_view of_key, std::string_view of_line) : name(of_key), line(of_line) {}

  operator std::string_view() const { return name; }

  std::string_view name;
  std::string_view line;
};

/// A visitor of keys that does with them what `Derived::value(key, member)` says, whatever they
/// take; derived classes hide the calls that mean more to them. The calls are those of MapReader,
/// where they are explained.
template <class Derived>
class FieldVisitor {
 public:
  void number(const KeyName& key, float value, const Range& /*range*/) { put(key, value); }
  template <std::integral T>
  void integer(const KeyName& key, T value, int64_t /*low*/, int64_t /*high*/) {
    put(key, value);
  }
  void integer(const KeyName& key, uint64_t value) { put(key, value); }
  void flag(const KeyName& key, bool value) { put(key, value); }
  void text(const KeyName& key, const std::string& value, std::string_view /*expected*/) {
    put(key, value);
  }
  void choice(const KeyName& key, const std::string& value,
              std::span<const std::string> /*names*/) {
    put(key, value);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(const KeyName& key, Enum value, std::span<const std::string> /*names*/) {
    put(key, static_cast<int32_t>(value));
  }
  void integers(const KeyName& /*key*/, const char* a_line, int32_t a, const char* b_line,
                int32_t b, int64_t /*low*/, int64_t /*high*/) {
    put(a_line, a);
    put(b_line, b);
  }
  void choices(const KeyName& key, const std::string& first, const char* second_line,
               const std::string& second, std::span<const std::string> /*names*/) {
    put(key, first);
    if (second != first) put(second_line, second);
  }
  void name_of(const KeyName& key, const std::string& value, NameKind /*kind*/) { put(key, value); }
  /// No list is another thing than an empty one.
  void names_of(const KeyName& key, const std::optional<std::vector<std::string>>& names,
                NameKind kind) {
    if (!names) return;
    put(key, static_cast<uint32_t>(names->size()));
    for (const std::string& name : *names) derived().name_of(key, name, kind);
  }
  void frame_file(const KeyName& key, const std::string& value, FrameFiles /*files*/) {
    derived().file(key, value);
  }
  void file(const KeyName& key, const std::string& value) { put(key, value); }
  void light_group(const KeyName& key, const std::string& value) { put(key, value); }
  void transform(const KeyName& key, const TransformList& value) { put(key, value); }
  template <class T>
  void animated(const KeyName& key, const T& value, const Range& /*range*/) {
    put(key, value);
  }
  template <class T>
  void animated_scale(const KeyName& key, const T& value, const Range& /*range*/) {
    put(key, value);
  }
  template <class T>
  void direction(const KeyName& key, const T& value) {
    put(key, value);
  }
  template <class T>
  void color(const KeyName& key, const T& value, const Range& /*range*/) {
    put(key, value);
  }
  template <class T>
  void color_input(const KeyName& key, const T& value, const Range& /*range*/) {
    put(key, value);
  }
  template <class T>
  void scalar_input(const KeyName& key, const T& value, const Range& /*range*/) {
    put(key, value);
  }
  void texture(const KeyName& key, const std::string& name) {
    derived().name_of(key, name, NameKind::texture);
  }
  template <class Desc>
  void map(const KeyName& /*key*/, const char* /*section*/, const Desc& desc) {
    Desc::fields(desc, derived());
  }
  template <class Desc>
  void map(const KeyName& key, const char* section, const std::optional<Desc>& desc) {
    if (desc) derived().map(key, section, *desc);
  }
  template <class Desc>
  void map_beside_value(const KeyName& key, const char* section, const std::optional<Desc>& desc) {
    derived().map(key, section, desc);
  }
  template <class Desc>
  void color_or_map(const KeyName& key, const char* section, const std::optional<Desc>& desc,
                    const Range& /*range*/) {
    derived().map(key, section, desc);
  }
  template <class Desc>
  void type_or_map(const KeyName& key, const char* section, const Desc& desc,
                   std::span<const std::string> /*types*/) {
    derived().map(key, section, desc);
  }
  void focus(const KeyName& /*key*/, const std::optional<Animated<float>>& distance,
             const std::string& object, const SourceLocation& /*where*/) {
    put("focus_distance", distance);
    derived().name_of("focus_object", object, NameKind::object);
  }
  template <class Stop>
  void stops(const KeyName& /*key*/, const std::vector<Stop>& stops) {
    for (const Stop& stop : stops) {
      put("stop.at", stop.at);
      put("stop.color", stop.color);
    }
  }
  template <class Unit, class T>
  void either(const KeyName& /*a_key*/, const Range& /*a_range*/, const KeyName& /*b_key*/,
              const Range& /*b_range*/, Unit unit, const T& value) {
    put("unit", static_cast<int32_t>(unit));
    put("amount", value);
  }
  template <class Pair>
  void overrides(const KeyName& key, const std::vector<Pair>& overrides) {
    for (const Pair& pair : overrides) {
      derived().name_of(key, pair.first, NameKind::material);
      derived().name_of("with", pair.second, NameKind::material);
    }
  }
  template <class Object>
  void children(const KeyName& /*key*/, const std::vector<Object>& children) {
    for (const Object& child : children) Object::fields(child, derived());
  }
  void place(const TransformList& steps, const Animated<Vec3>& at) {
    transform("transform", steps);
    put("at", at);
  }

  /// Which pixels are rendered, not what they show.
  template <class Film>
  void crop(const KeyName& /*key*/, const Film& /*film*/) {}

  // What only readers need to know.
  template <class Desc>
  void preset(const KeyName& /*key*/, const Desc& /*desc*/) {}
  void enter_section(std::string_view /*section*/) {}
  void require(const KeyName& /*key*/, std::string_view /*expected*/) {}
  void starts_at(float /*value*/, float /*start*/) {}
  void keep_apart(std::string_view /*a_key*/, const Animated<Vec3>& /*a*/,
                  std::string_view /*b_key*/, const Animated<Vec3>& /*b*/) {}

 private:
  Derived& derived() { return static_cast<Derived&>(*this); }

  template <class T>
  void put(const KeyName& key, const T& value) {
    derived().value(key.line, value);
  }
  template <class T>
  void put(const KeyName& key, const std::optional<T>& value) {
    if (value) derived().value(key.line, *value);
  }
};

}  // namespace hyades::core
