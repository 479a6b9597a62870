#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hyades::core {

/// The first thing that is wrong with a JSON document.
struct JsonTrouble {
  std::string message;  ///< "meshes[2].primitives[0].mode is 9, expected ..."; empty: nothing

  bool none() const { return message.empty(); }
};

/// A value of a JSON document and its place there. Whoever asks for what is not there, or for
/// something of another kind, gets a default, and the trouble is told; asking on is harmless.
class JsonValue {
 public:
  JsonValue(const nlohmann::json* value, std::string place, JsonTrouble& trouble)
      : value_(value), place_(std::move(place)), trouble_(&trouble) {}

  bool exists() const { return value_ != nullptr; }
  const std::string& place() const { return place_; }
  const nlohmann::json* raw() const { return value_; }
  void complain(const std::string& what) const;  ///< "<place> <what>", if it is the first

  /// The member `key` of an object; one that does not exist where there is none.
  JsonValue member(std::string_view key) const;
  bool has(std::string_view key) const { return member(key).exists(); }
  /// The members' names.
  std::vector<std::string> keys() const;

  /// The items of list `key`; none where there is none.
  std::vector<JsonValue> list(std::string_view key) const;

  /// A whole number within low..high; `absent` where there is no such key.
  int64_t integer(std::string_view key, int64_t low, int64_t high, int64_t absent) const;
  int64_t required_integer(std::string_view key, int64_t low, int64_t high) const;
  /// An index below `count`, or -1 where there is no such key.
  int index(std::string_view key, size_t count) const;
  int required_index(std::string_view key, size_t count) const;

  float number(std::string_view key, float absent, float low = -3.0e38F,
               float high = 3.0e38F) const;
  /// Exactly out.size() numbers; false, and nothing is changed, where there is no such key.
  bool numbers(std::string_view key, std::span<float> out) const;
  std::vector<float> numbers(std::string_view key) const;
  std::string text(std::string_view key) const;  ///< empty where there is none
  bool flag(std::string_view key, bool absent) const;

  /// This value itself as an index below `count`.
  int as_index(size_t count) const;
  std::string as_text() const;

 private:
  std::optional<int64_t> whole(int64_t low, int64_t high) const;
  std::optional<float> real() const;

  const nlohmann::json* value_;
  std::string place_;
  JsonTrouble* trouble_;
};

}  // namespace hyades::core
