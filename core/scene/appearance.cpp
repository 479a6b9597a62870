#include "core/scene/appearance.h"

#include <algorithm>
#include <vector>

#include "core/scene/material_makers.h"
#include "core/scene/medium_makers.h"
#include "core/scene/texture_makers.h"

namespace hyades::core {
namespace {

constexpr int kMaxReferenceDepth = 64;

template <class Desc>
const Desc* find_named(const std::vector<Desc>& list, const std::string& name) {
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const Desc& d) { return d.name == name; });
  return it == list.end() ? nullptr : &*it;
}

}  // namespace

Result<TexturePtr> Appearance::texture(const std::string& name) {
  if (const auto it = textures_.find(name); it != textures_.end()) return it->second;
  const TextureDesc* desc = find_named(job_.textures, name);
  if (desc == nullptr) return Error{"there is no texture '" + name + "'"};
  if (++depth_ > kMaxReferenceDepth) return Error{"texture '" + name + "' refers to itself"};
  auto made = make_texture(*desc, *this);
  --depth_;
  if (!made) return made.error().in("texture '" + name + "'");
  return textures_[name] = *made;
}

Result<MaterialPtr> Appearance::material(const std::string& name) {
  if (const auto it = materials_.find(name); it != materials_.end()) return it->second;
  if (name.empty()) return materials_[name] = make_lambert({Rgb(0.5F), nullptr});
  const MaterialDesc* desc = find_named(job_.materials, name);
  if (desc == nullptr) return Error{"there is no material '" + name + "'"};
  if (++depth_ > kMaxReferenceDepth) return Error{"material '" + name + "' refers to itself"};
  auto made = make_material(*desc, *this);
  --depth_;
  if (!made) return made.error().in("material '" + name + "'");
  MaterialPtr result = *made;
  if (desc->bump) {
    auto height = texture(desc->bump->texture);
    if (!height) return height.error().in("material '" + name + "'");
    auto strength = scalar(desc->bump->strength);
    if (!strength) return strength.error().in("material '" + name + "'");
    const float scale = desc->bump->height.at(time_) * job_.units;
    result = make_bump(result, *height, scale, *strength);
  }
  if (desc->normal_map) {
    auto normals = texture(desc->normal_map->texture);
    if (!normals) return normals.error().in("material '" + name + "'");
    auto strength = scalar(desc->normal_map->strength);
    if (!strength) return strength.error().in("material '" + name + "'");
    result = make_normal_map(result, *normals, *strength);
  }
  auto opacity = scalar(desc->opacity);
  if (!opacity) return opacity.error().in("material '" + name + "'");
  return materials_[name] = make_cutout(result, *opacity);
}

Result<MaterialPtr> Appearance::surface(const std::string& material, const std::string& interior) {
  const MediumDesc* inside = find_named(job_.media, interior);
  if (!material.empty() || inside == nullptr || !inside->index) return this->material(material);
  const float index = inside->index->at(time_);
  if (index == 1.0F) return make_null();
  return make_dielectric(index, Rgb(1.0F), Rgb(1.0F));
}

MediumPtr Appearance::grouped(MediumPtr medium, const MediumDesc& desc) {
  if (!desc.light_group.empty()) medium_groups_.emplace_back(medium.get(), desc.light_group);
  return medium;
}

Result<MediumPtr> Appearance::medium(const std::string& name) {
  if (name.empty()) return MediumPtr();
  if (const auto it = media_.find(name); it != media_.end()) return it->second;
  const MediumDesc* desc = find_named(job_.media, name);
  if (desc == nullptr) return Error{"there is no medium '" + name + "'"};
  if (desc->varying) return Error{"medium '" + name + "' varies from place to place of a body"};
  return media_[name] = grouped(make_medium(*desc, time_, job_.units), *desc);
}

Result<MediumPtr> Appearance::medium_in(const std::string& name, const Placement& body) {
  const MediumDesc* desc = find_named(job_.media, name);
  if (desc == nullptr || !desc->varying) return medium(name);
  const Bounds bounds = bounds_of(body.shape);
  const Vec3& a = bounds.lower;
  const Vec3& b = bounds.upper;
  const auto key = std::make_pair(name, std::array<float, 6>{a.x, a.y, a.z, b.x, b.y, b.z});
  auto found = volumes_.find(key);
  if (found == volumes_.end()) {
    auto volume = make_volume(*desc, time_, bounds, cache_);
    if (!volume) return volume.error().in("medium '" + name + "'");
    found = volumes_.emplace(key, std::move(*volume)).first;
  }
  return grouped(make_medium_in(*desc, time_, job_.units, found->second, body.to_world), *desc);
}

bool Appearance::has_subsurface(const std::string& name) const {
  const MaterialDesc* desc = find_named(job_.materials, name);
  return desc != nullptr && subsurface_of(*desc) != nullptr;
}

MediumPtr Appearance::subsurface(const std::string& name) {
  MediumPtr& made = subsurfaces_[name];
  if (!made) made = make_subsurface(*find_named(job_.materials, name), time_, job_.units);
  return made;
}

Result<ColorParam> Appearance::color(const ColorInput& input) {
  if (input.texture.empty()) return ColorParam{input.value.at(time_), nullptr};
  auto found = texture(input.texture);
  if (!found) return found.error();
  return ColorParam{Rgb(0.0F), *found};
}

Result<ScalarParam> Appearance::scalar(const ScalarInput& input) {
  if (input.texture.empty()) return ScalarParam{input.value.at(time_), nullptr};
  auto found = texture(input.texture);
  if (!found) return found.error();
  return ScalarParam{0.0F, *found};
}

Result<TexturePtr> Appearance::color_texture(const ColorInput& input) {
  if (!input.texture.empty()) return texture(input.texture);
  return make_constant_texture(input.value.at(time_));
}

}  // namespace hyades::core
