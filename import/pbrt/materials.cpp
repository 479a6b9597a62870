#include "import/pbrt/materials.h"

#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "core/job/yaml_writer.h"
#include "import/pbrt/made_meshes.h"
#include "import/pbrt/material_kinds.h"

namespace hyades::core::pbrt {

Materials::Materials(Context& context, Textures& textures)
    : context_(context), textures_(textures) {
  for (const NamedEntity& m : context.scene.named_materials) named_[m.name] = &m;
}

const WrittenMaterial& Materials::of(const ShapeEntity& shape) {
  static const WrittenMaterial none;
  if (shape.material_name.empty()) {
    const Entity& entity = context_.scene.materials[shape.material];
    return written(entity, entity.type, entity.type.empty() ? "interface" : entity.type,
                   is_strand(shape));
  }
  const auto found = named_.find(shape.material_name);
  if (found == named_.end()) {
    context_.report.error(shape.place, "there is no material '" + shape.material_name + "'");
    return none;
  }
  ParameterReader reader(found->second->parameters, found->second->place, context_.report);
  return written(*found->second, reader.text("type"), shape.material_name, is_strand(shape));
}

const WrittenMaterial& Materials::written(const Entity& entity, const std::string& type,
                                          const std::string& wish, bool strands) {
  const auto [known, is_new] = written_.emplace(std::pair(&entity, strands), WrittenMaterial());
  WrittenMaterial& place = known->second;  // stays where it is while others are added
  if (!is_new) {
    if (making_.contains(&entity)) {
      context_.report.error(entity.place, "material '" + wish + "' is made of itself");
    }
    return place;
  }
  if (making_.size() > static_cast<size_t>(kLongestChain)) {
    context_.report.error(
        entity.place,
        fmt::format("material '{}' is the end of more than {} in a row", wish, kLongestChain));
    return place;
  }
  making_.insert(&entity);
  MadeMaterial made = MaterialKinds(*this, context_, textures_, entity, wish, strands).make(type);
  making_.erase(&entity);
  if (made.node == nullptr) return place;
  WrittenMaterial out;
  out.interior = made.interior;
  out.is_interface = made.is_interface;
  out.sided = type == "dielectric" || type == "subsurface" || out.is_interface ||
              made.node->find("bump") != nullptr || made.node->find("normal_map") != nullptr;
  // Scenes say the same again and again where materials have no names.
  std::string& same = same_[wish + "\n" + write_yaml(*made.node) + made.interior];
  if (same.empty()) {
    same = context_.material_names.add(wish);
    context_.materials.put(same, made.node);
  }
  out.name = same;
  place = out;
  return place;
}

std::string Materials::cut_out(const WrittenMaterial& material, const YamlPtr& opacity) {
  std::string& name = cut_outs_[material.name + "\n" + opacity->scalar];
  if (name.empty()) {
    name = context_.material_names.add("cutout");
    context_.materials.put(
        name, YamlMap{{"like", yaml_text(material.name)}, {"opacity", opacity}}.node());
  }
  return name;
}

}  // namespace hyades::core::pbrt
