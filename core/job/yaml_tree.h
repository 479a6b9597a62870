#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/job/source.h"

namespace hyades::core {

struct YamlNode;
using YamlPtr = std::shared_ptr<const YamlNode>;

/// Where a node stands; a SourceLocation that shares its file name, because there are many.
struct YamlPlace {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;
  operator SourceLocation() const {  // NOLINT: implicit on purpose: the same thing, made small
    return {file ? *file : std::string(), line, column};
  }
};

/// One `key: value` of a map.
struct YamlEntry {
  std::string key;
  YamlPlace key_where;
  YamlPtr value;
};

/// A piece of YAML with the place where it stands. Immutable once parsed; aliases share nodes.
struct YamlNode {
  enum class Kind : uint8_t { null, scalar, list, map };
  Kind kind = Kind::null;
  bool quoted = false;  ///< scalar in quotes or a block scalar: always text
  YamlPlace where;      ///< null: the place of its key
  std::string scalar;   ///< scalar only
  std::vector<YamlPtr> list;
  std::vector<YamlEntry> map;  ///< in document order, keys distinct
  /// Nodes below and including this one, aliases counted in full; long texts count as several.
  uint64_t weight = 1;

  const YamlEntry* find(std::string_view key) const;
};

/// Limits of one YAML text: what no honest job comes near to.
inline constexpr size_t kMaxYamlBytes = size_t{32} << 20;
inline constexpr uint64_t kMaxYamlNodes = uint64_t{1} << 20;  ///< aliases counted in full
inline constexpr int kMaxYamlDepth = 64;
inline constexpr size_t kMaxYamlScalar = size_t{64} << 10;

/// How many values a text of so many bytes counts as: it is copied where it is used.
constexpr uint64_t weight_of_text(size_t bytes) { return 1 + bytes / 32; }

/// Parses one YAML document. Complains (and returns null) about: syntax, text that is not UTF-8,
/// control characters, keys that are not plain text, tags, several documents, `<<`, an alias inside
/// its own anchor, and anything over the limits above. Duplicate keys are complaints too, but do
/// not stop it. An empty document is a null node.
YamlPtr parse_yaml(std::string_view text, const std::string& file, Diagnostics& diagnostics);

/// A map without keys.
const YamlNode& empty_map();

/// "a list", "a map", "nothing", "the number 3", "the text 'abc'": for complaints.
std::string describe(const YamlNode& node);

}  // namespace hyades::core
