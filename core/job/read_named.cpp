#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/job/like.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

void read_named(MapReader& parent, std::string_view key, const std::string& noun,
                std::optional<NameKind> kind,
                const std::function<void(MapReader& reader, const std::string& name)>& read) {
  const std::string path =
      parent.path().empty() ? std::string(key) : fmt::format("{}.{}", parent.path(), key);
  const auto read_one = [&](const YamlNode& node, const std::string& name, const std::string& what,
                            const std::string& where) {
    MapReader reader(parent.context(), node, what, where, std::string(key));
    if (node.kind != YamlNode::Kind::map) return;
    reader.leave_to_others("like");  // resolve_likes
    if (reader.listing()) reader.tell("like", {.takes = "text"});
    read(reader, name);
  };
  if (parent.listing()) {
    parent.tell(key, {.takes = "entries", .below = std::string(key)});
    read_one(empty_map(), noun, noun, path);
    return;
  }
  const YamlNode* section = parent.find(key);
  if (section == nullptr) return;
  if (section->kind != YamlNode::Kind::map) {
    parent.mismatch(key, *section, "a map of names, such as {name: {...}}");
    return;
  }
  ReadContext& context = parent.context();
  for (const YamlEntry& entry : resolve_likes(context, *section)) {
    if (!context.spend(1, entry.key_where)) return;
    const bool reads_as_color = noun == "texture" && looks_like_color(entry.key);
    if (!is_valid_name(entry.key) || reads_as_color) {
      context.complain(
          entry.key_where,
          fmt::format("'{}' cannot be the name of {} {}: expected letters, digits, '_', '-', '.'"
                      " and inner spaces, at most 100{}",
                      entry.key.substr(0, 60), noun.starts_with('o') ? "an" : "a", noun,
                      reads_as_color ? ", that do not read as a colour or number" : ""));
      continue;
    }
    if (kind) context.given[static_cast<size_t>(*kind)].push_back(entry.key);
    if (entry.value->kind == YamlNode::Kind::null) {
      context.complain(entry.key_where,
                       fmt::format("{} '{}' is empty, expected a map", noun, entry.key));
      continue;
    }
    read_one(*entry.value, entry.key, fmt::format("{} '{}'", noun, entry.key),
             fmt::format("{}.{}", path, entry.key));
  }
}

}  // namespace hyades::core
