#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/job/like.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

void MapReader::overrides(std::string_view key,
                          std::vector<std::pair<std::string, std::string>>& overrides) {
  if (listing()) tell(key, {.takes = "overrides", .below = "materials"});
  const YamlNode* all = find(key);
  if (all == nullptr) return;
  if (all->kind != YamlNode::Kind::map) {
    return mismatch(key, *all, "a map of materials, such as {clay: {color: 0.2}} or {clay: steel}");
  }
  for (const YamlEntry& entry : all->map) {
    if (!context_.spend(1, entry.key_where)) return;
    const std::string label = fmt::format("{} of {}", key, what_);
    const auto original = context_.materials.find(entry.key);
    context_.names.push_back({NameKind::material, entry.key, entry.key_where, label});
    if (original == context_.materials.end()) continue;
    const YamlNode& value = *entry.value;
    if (value.kind == YamlNode::Kind::scalar) {
      context_.names.push_back({NameKind::material, value.scalar, value.where, label});
      overrides.emplace_back(entry.key, value.scalar);
    } else if (value.kind == YamlNode::Kind::map) {
      // No name that a job could give.
      const std::string name = fmt::format("{} / {}", path_, entry.key);
      const YamlPtr changed = merged(value, *original->second);
      MapReader material(context_, *changed, fmt::format("material '{}' of {}", entry.key, what_),
                         name, "materials");
      material.leave_to_others("like");
      read_material(material, name);
      overrides.emplace_back(entry.key, name);
    } else {
      context_.complain(value.where, fmt::format("{} is {}, expected keys of the material '{}', or "
                                                 "another one's name",
                                                 label, describe(value), entry.key));
    }
  }
}

}  // namespace hyades::core
