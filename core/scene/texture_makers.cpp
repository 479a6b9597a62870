#include "core/scene/texture_makers.h"

#include <optional>

#include "core/scene/name_table.h"

namespace hyades::core {
namespace {

constexpr std::array<NameRow<ColorSpace>, 3> kColorSpaces = {{
    {"auto", ColorSpace::automatic},
    {"srgb", ColorSpace::srgb},
    {"linear", ColorSpace::linear},
}};

constexpr std::array<NameRow<WrapMode>, 4> kWraps = {{
    {"repeat", WrapMode::repeat},
    {"clamp", WrapMode::clamp},
    {"mirror", WrapMode::mirror},
    {"black", WrapMode::black},
}};

constexpr std::array<NameRow<TextureFilter>, 2> kFilters = {{
    {"bilinear", TextureFilter::bilinear},
    {"nearest", TextureFilter::nearest},
}};

/// "default" is what the type of texture prefers.
constexpr std::array<NameRow<std::optional<Mapping>>, 4> kMappings = {{
    {"default", std::nullopt},
    {"uv", Mapping::uv},
    {"object", Mapping::object},
    {"world", Mapping::world},
}};

Result<TexturePtr> make_constant(const TextureDesc& desc, Appearance& looks) {
  return looks.color_texture(desc.a);
}

Result<TexturePtr> make_image(const TextureDesc& desc, Appearance& looks) {
  const auto space = color_space_of(desc);
  if (!space) return space.error();
  const auto wrap = look_up(kWraps, desc.wrap, "wrap");
  if (!wrap) return wrap.error();
  const auto filter = look_up(kFilters, desc.filter, "filter of textures");
  if (!filter) return filter.error();
  auto image = looks.cache().image(desc.file, *space);
  if (!image) return image.error();
  return make_image_texture(*image, (*wrap)->value, (*filter)->value,
                            Vec2(desc.scale.at(looks.time())), Vec2(desc.offset.at(looks.time())));
}

/// What `desc` maps to, in the job's unit of length; `preferred` where it does not say.
Result<MappingDesc> mapping_of(const TextureDesc& desc, const Appearance& looks,
                               Mapping preferred) {
  const auto named = look_up(kMappings, desc.mapping, "mapping");
  if (!named) return named.error();
  MappingDesc mapping{(*named)->value.value_or(preferred), desc.scale.at(looks.time()),
                      desc.offset.at(looks.time())};
  // World positions are in metres, the job's scale counts cells per its own unit of length.
  if (mapping.mapping == Mapping::world) mapping.scale /= looks.units();
  return mapping;
}

/// A texture that goes between two others.
struct Pair {
  TexturePtr a, b;
};

Result<Pair> pair_of(const TextureDesc& desc, Appearance& looks) {
  auto a = looks.color_texture(desc.a);
  if (!a) return a.error();
  auto b = looks.color_texture(desc.b);
  if (!b) return b.error();
  return Pair{*a, *b};
}

Result<TexturePtr> make_scale(const TextureDesc& desc, Appearance& looks) {
  auto factors = pair_of(desc, looks);
  if (!factors) return factors.error();
  return make_scale_texture(factors->a, factors->b);
}

Result<TexturePtr> make_checker(const TextureDesc& desc, Appearance& looks) {
  auto colors = pair_of(desc, looks);
  if (!colors) return colors.error();
  const auto mapping = mapping_of(desc, looks, Mapping::uv);
  if (!mapping) return mapping.error();
  return make_checker_texture(colors->a, colors->b, *mapping);
}

template <int dimensions>
Result<TexturePtr> make_noise(const TextureDesc& desc, Appearance& looks) {
  auto colors = pair_of(desc, looks);
  if (!colors) return colors.error();
  const auto mapping = mapping_of(desc, looks, Mapping::object);
  if (!mapping) return mapping.error();
  NoiseDesc noise;
  noise.dimensions = dimensions;
  noise.octaves = desc.octaves;
  noise.lacunarity = desc.lacunarity;
  noise.gain = desc.gain;
  noise.time = desc.time.at(looks.time());
  return make_noise_texture(colors->a, colors->b, noise, *mapping);
}

using Maker = Result<TexturePtr> (*)(const TextureDesc&, Appearance&);
constexpr std::array<NameRow<Maker>, 8> kMakers = {{
    {"constant", make_constant},
    {"image", make_image},
    {"checker", make_checker},
    {"scale", make_scale},
    {"perlin3d", make_noise<3>},
    {"perlin4d", make_noise<4>},
    {"fbm3d", make_noise<3>},
    {"fbm4d", make_noise<4>},
}};

}  // namespace

Result<TexturePtr> make_texture(const TextureDesc& desc, Appearance& looks) {
  const auto make = look_up(kMakers, desc.type, "type of texture");
  if (!make) return make.error();
  return (*make)->value(desc, looks);
}

Result<ColorSpace> color_space_of(const TextureDesc& desc) {
  const auto space = look_up(kColorSpaces, desc.color_space, "color_space");
  if (!space) return space.error();
  return (*space)->value;
}

std::vector<std::string> made_texture_types() { return names_of(kMakers); }
std::vector<std::string> made_color_spaces() { return names_of(kColorSpaces); }
std::vector<std::string> made_wraps() { return names_of(kWraps); }
std::vector<std::string> made_texture_filters() { return names_of(kFilters); }
std::vector<std::string> made_mappings() { return names_of(kMappings); }

}  // namespace hyades::core
