#include "core/job/read_overrides.h"

#include <fmt/format.h>

#include "core/job/like.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

void read_overrides(MapReader& reader, ObjectDesc& object) {
  const YamlNode* all = reader.find("override");
  if (all == nullptr) return;
  ReadContext& context = reader.context();
  if (all->kind != YamlNode::Kind::map) {
    reader.mismatch("override", *all,
                    "a map of materials, such as {clay: {color: 0.2}} or {clay: steel}");
    return;
  }
  for (const YamlEntry& entry : all->map) {
    if (!context.spend(1, entry.key_where)) return;
    const std::string label = fmt::format("override of {}", reader.what());
    const auto original = context.materials.find(entry.key);
    context.names.push_back({NameKind::material, entry.key, entry.key_where, label});
    if (original == context.materials.end()) continue;
    const YamlNode& value = *entry.value;
    if (value.kind == YamlNode::Kind::scalar) {
      context.names.push_back({NameKind::material, value.scalar, value.where, label});
      object.overrides.emplace_back(entry.key, value.scalar);
    } else if (value.kind == YamlNode::Kind::map) {
      // No name that a job could give.
      const std::string name = fmt::format("{} / {}", reader.path(), entry.key);
      const YamlPtr changed = merged(value, *original->second);
      MapReader material(context, *changed,
                         fmt::format("material '{}' of {}", entry.key, reader.what()), name,
                         "materials");
      material.leave_to_others("like");
      read_material(material, name);
      object.overrides.emplace_back(entry.key, name);
    } else {
      context.complain(value.where, fmt::format("{} is {}, expected keys of the material '{}', or "
                                                "another one's name",
                                                label, describe(value), entry.key));
    }
  }
}

}  // namespace hyades::core
