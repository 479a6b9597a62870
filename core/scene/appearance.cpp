#include "core/scene/appearance.h"

#include <algorithm>

namespace hyades::core {
namespace {

constexpr int kMaxReferenceDepth = 64;

template <class Desc>
const Desc* find_named(const std::vector<Desc>& list, const std::string& name) {
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const Desc& d) { return d.name == name; });
  return it == list.end() ? nullptr : &*it;
}

WrapMode wrap_mode(const std::string& name) {
  if (name == "clamp") return WrapMode::clamp;
  if (name == "mirror") return WrapMode::mirror;
  if (name == "black") return WrapMode::black;
  return WrapMode::repeat;
}

ColorSpace color_space(const std::string& name) {
  if (name == "srgb") return ColorSpace::srgb;
  if (name == "linear") return ColorSpace::linear;
  return ColorSpace::automatic;
}

Mapping mapping_of(const TextureDesc& desc) {
  if (desc.mapping == "uv") return Mapping::uv;
  if (desc.mapping == "object") return Mapping::object;
  if (desc.mapping == "world") return Mapping::world;
  return desc.type == "checker" ? Mapping::uv : Mapping::object;
}

}  // namespace

Result<TexturePtr> Appearance::texture(const std::string& name) {
  if (const auto it = textures_.find(name); it != textures_.end()) return it->second;
  const TextureDesc* desc = find_named(job_.textures, name);
  if (desc == nullptr) return Error{"there is no texture '" + name + "'"};
  if (++depth_ > kMaxReferenceDepth) return Error{"texture '" + name + "' refers to itself"};
  auto made = make_texture(*desc);
  --depth_;
  if (!made) return made.error().in("texture '" + name + "'");
  return textures_[name] = *made;
}

Result<TexturePtr> Appearance::color_texture(const ColorInput& input) {
  if (!input.texture.empty()) return texture(input.texture);
  return make_constant_texture(input.value.at(time_));
}

Result<TexturePtr> Appearance::make_texture(const TextureDesc& desc) {
  const Vec3 scale = desc.scale.at(time_);
  const Vec3 offset = desc.offset.at(time_);
  if (desc.type == "image") {
    auto image = cache_.image(desc.file, color_space(desc.color_space));
    if (!image) return image.error();
    return make_image_texture(
        *image, wrap_mode(desc.wrap),
        desc.filter == "nearest" ? TextureFilter::nearest : TextureFilter::bilinear, Vec2(scale),
        Vec2(offset));
  }
  auto a = color_texture(desc.a);
  if (!a) return a;
  if (desc.type == "constant") return a;
  auto b = color_texture(desc.b);
  if (!b) return b;
  if (desc.type == "scale") return make_scale_texture(*a, *b);

  MappingDesc mapping{mapping_of(desc), scale, offset};
  // World positions are in metres, the job's scale counts cells per its own unit of length.
  if (mapping.mapping == Mapping::world) mapping.scale /= job_.units;
  if (desc.type == "checker") return make_checker_texture(*a, *b, mapping);

  NoiseDesc noise;
  noise.dimensions = desc.type.ends_with("4d") ? 4 : 3;
  noise.octaves = desc.octaves;
  noise.lacunarity = desc.lacunarity;
  noise.gain = desc.gain;
  noise.time = desc.time.at(time_);
  return make_noise_texture(*a, *b, noise, mapping);
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

Result<MaterialPtr> Appearance::material(const std::string& name) {
  if (const auto it = materials_.find(name); it != materials_.end()) return it->second;
  if (name.empty()) return materials_[name] = make_lambert({Rgb(0.5F), nullptr});
  const MaterialDesc* desc = find_named(job_.materials, name);
  if (desc == nullptr) return Error{"there is no material '" + name + "'"};
  if (++depth_ > kMaxReferenceDepth) return Error{"material '" + name + "' refers to itself"};
  auto made = make_material(*desc);
  --depth_;
  if (!made) return made.error().in("material '" + name + "'");
  MaterialPtr result = *made;
  if (desc->bump) {
    auto height = texture(desc->bump->texture);
    if (!height) return height.error().in("material '" + name + "'");
    result = make_bump(result, *height, desc->bump->height.at(time_) * job_.units);
  }
  return materials_[name] = result;
}

Result<MaterialPtr> Appearance::make_material(const MaterialDesc& desc) {
  const std::string& type = desc.type;
  const auto scattering =
      desc.multiple_scattering ? FacetScattering::multiple : FacetScattering::single;
  if (type == "null") return make_null();
  if (type == "black") return make_black();
  if (type == "dielectric") {
    auto roughness = scalar(desc.roughness);
    if (!roughness) return roughness.error();
    return make_rough_dielectric(desc.ior.at(time_), desc.transmission.at(time_),
                                 desc.reflection.at(time_), *roughness);
  }
  if (type == "thin-dielectric") {
    return make_thin_dielectric(desc.ior.at(time_), desc.transmission.at(time_),
                                desc.reflection.at(time_));
  }
  if (type == "conductor") {
    MetalIndex index;
    if (desc.eta && desc.k) {
      index.eta = desc.eta->at(time_);
      index.k = desc.k->at(time_);
    } else {
      const auto found = find_metal(desc.metal);
      if (!found) return Error{"there is no metal '" + desc.metal + "' in the table"};
      index = *found;
    }
    auto roughness = scalar(desc.roughness);
    if (!roughness) return roughness.error();
    return make_conductor(index.eta, index.k, *roughness, desc.reflection.at(time_), scattering);
  }
  if (type == "mix") {
    auto first = material(desc.first);
    if (!first) return first;
    auto second = material(desc.second);
    if (!second) return second;
    auto amount = scalar(desc.amount);
    if (!amount) return amount.error();
    return make_mix(*first, *second, *amount);
  }

  auto base = color(desc.color);
  if (!base) return base.error();
  if (type == "lambert") return make_lambert(*base);
  if (type == "mirror") return make_mirror(*base);
  if (type == "glossy") {
    auto reflectiveness = scalar(desc.reflectiveness);
    if (!reflectiveness) return reflectiveness.error();
    auto glossiness = scalar(desc.glossiness);
    if (!glossiness) return glossiness.error();
    return make_glossy(*base, *reflectiveness, *glossiness, scattering);
  }
  return Error{"there is no kind of material called '" + type + "'"};
}

}  // namespace hyades::core
