#include "core/job/check_materials.h"

#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/job/references.h"

namespace hyades::core {
namespace {

using MaterialsByName = std::map<std::string, const MaterialDesc*>;

MaterialsByName materials_by_name(const Job& job) {
  MaterialsByName all;
  for (const MaterialDesc& material : job.materials) all.emplace(material.name, &material);
  return all;
}

/// Whether light may go through surfaces of that material itself.
bool lets_through(const MaterialDesc& m) {
  const auto may_be_positive = [](const ScalarInput& input) {
    return !input.texture.empty() || !input.value.is_constant() || input.value.constant > 0.0F;
  };
  const bool whole = m.opacity.texture.empty() && m.opacity.value.is_constant() &&
                     m.opacity.value.constant >= 1.0F;
  const bool clear = std::visit([](const auto& kind) { return kind.kTraits.clear; }, m.kind);
  if (!whole || clear || subsurface_of(m) != nullptr) return true;
  const auto* principled = std::get_if<PrincipledDesc>(&m.kind);
  return principled != nullptr && (may_be_positive(principled->transmission) ||
                                   may_be_positive(principled->diffuse_transmission));
}

/// What `material` or what it is made of lets light through. Null: nothing, and all of it is now
/// among `opaque`, which is not looked at again: many may be made of the same.
const MaterialDesc* transparent_part(const MaterialsByName& all, const MaterialDesc& material,
                                     std::set<const MaterialDesc*>& opaque) {
  std::vector<const MaterialDesc*> left = {&material};
  std::set<const MaterialDesc*> seen;
  while (!left.empty()) {
    const MaterialDesc* m = left.back();
    left.pop_back();
    if (opaque.contains(m) || !seen.insert(m).second) continue;
    if (lets_through(*m)) return m;
    for (const std::string& name : names_in(*m, NameKind::material)) {
      const auto part = all.find(name);
      if (part != all.end()) left.push_back(part->second);
    }
  }
  opaque.merge(seen);
  return nullptr;
}

}  // namespace

void check_two_sided(ReadContext& context) {
  const MaterialsByName all = materials_by_name(context.job);
  std::set<const MaterialDesc*> opaque;
  for (const MaterialDesc& material : context.job.materials) {
    if (!std::holds_alternative<TwoSidedDesc>(material.kind)) continue;
    if (context.diagnostics.full()) return;
    for (const std::string& name : names_in(material, NameKind::material)) {
      const auto part = all.find(name);
      if (part == all.end()) continue;
      const MaterialDesc* clear = transparent_part(all, *part->second, opaque);
      if (clear == nullptr) continue;
      context.complain(material.where,
                       fmt::format("material '{}' is two-sided, but '{}' lets light through, "
                                   "expected parts that do not (and an opacity of the whole)",
                                   material.name, clear->name));
    }
  }
}

void check_emission(ReadContext& context) {
  const MaterialsByName all = materials_by_name(context.job);
  for (const MaterialDesc& material : context.job.materials) {
    for (const std::string& name : names_in(material, NameKind::material)) {
      const auto part = all.find(name);
      if (part == all.end()) continue;
      const auto* principled = std::get_if<PrincipledDesc>(&part->second->kind);
      if (principled == nullptr || !principled->emits()) continue;
      context.complain(material.where,
                       fmt::format("'{}' is a part of material '{}' and has an emission_strength, "
                                   "expected one of 0: parts do not shine",
                                   name, material.name));
    }
  }
}

void read_normal_maps_as_numbers(ReadContext& context) {
  std::set<std::string> maps;
  for (const MaterialDesc& material : context.job.materials) {
    if (material.normal_map) maps.insert(material.normal_map->texture);
  }
  for (TextureDesc& texture : context.job.textures) {
    auto* image = std::get_if<textures::Image>(&texture.kind);
    if (image == nullptr || !maps.contains(texture.name)) continue;
    if (image->color_space == "auto") image->color_space = "linear";
    if (image->color_space == "linear") continue;
    context.complain(texture.where, fmt::format("texture '{}' is a normal map with color_space "
                                                "'{}', expected linear",
                                                texture.name, image->color_space));
  }
}

}  // namespace hyades::core
