#include "core/job/read_textures.h"

#include <fmt/format.h>

#include <array>

#include "core/job/kinds.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

const std::array<std::string, 3> kColorSpaces = {"auto", "srgb", "linear"};
const std::array<std::string, 4> kWraps = {"repeat", "clamp", "mirror", "black"};
const std::array<std::string, 2> kFilters = {"bilinear", "nearest"};
const std::array<std::string, 4> kMappings = {"default", "uv", "object", "world"};

void read_placement(MapReader& reader, TextureDesc& texture) {
  reader.animated_scale("scale", texture.scale, kAnyNumber);
  reader.animated_scale("offset", texture.offset, kAnyNumber);
}

void read_two_colors(MapReader& reader, TextureDesc& texture) {
  texture.a = ColorInput{Animated<Rgb>(Rgb(0.0F)), {}};
  texture.b = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  reader.color_input("a", texture.a, kNotNegative);
  reader.color_input("b", texture.b, kNotNegative);
  reader.choice("mapping", texture.mapping, kMappings);
  read_placement(reader, texture);
}

void read_constant(MapReader& reader, TextureDesc& texture) {
  reader.require("value", "a colour");
  reader.color_input("value", texture.a, kNotNegative);
}

void read_image(MapReader& reader, TextureDesc& texture) {
  reader.require("file", "an image file");
  reader.file("file", texture.file);
  reader.choice("color_space", texture.color_space, kColorSpaces);
  reader.choice("wrap", texture.wrap, kWraps);
  reader.choice("filter", texture.filter, kFilters);
  read_placement(reader, texture);
}

void read_product(MapReader& reader, TextureDesc& texture) {
  reader.require("input", "a colour or texture");
  reader.color_input("input", texture.a, kNotNegative);
  reader.color_input("factor", texture.b, kNotNegative);
}

void read_noise(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  reader.integer("octaves", texture.octaves, 1, 16);
  reader.number("lacunarity", texture.lacunarity, {1.0, 16.0});
  reader.number("gain", texture.gain, {0.0, 4.0});
}

void read_noise_4d(MapReader& reader, TextureDesc& texture) {
  read_noise(reader, texture);
  reader.animated("time", texture.time, kAnyNumber);
}

void read_fbm(MapReader& reader, TextureDesc& texture) {
  texture.octaves = 4;
  read_noise(reader, texture);
}

void read_fbm_4d(MapReader& reader, TextureDesc& texture) {
  texture.octaves = 4;
  read_noise_4d(reader, texture);
}

const std::array<TypeRow<TextureDesc>, 8> kTypes = {{
    {"constant", read_constant},
    {"image", read_image},
    {"checker", read_two_colors},
    {"scale", read_product},
    {"perlin3d", read_noise},
    {"perlin4d", read_noise_4d},
    {"fbm3d", read_fbm},
    {"fbm4d", read_fbm_4d},
}};

}  // namespace

std::vector<std::string> texture_types() { return type_names<TextureDesc>(kTypes); }
std::span<const std::string> color_space_names() { return kColorSpaces; }
std::span<const std::string> wrap_names() { return kWraps; }
std::span<const std::string> texture_filter_names() { return kFilters; }
std::span<const std::string> mapping_names() { return kMappings; }

void read_texture(ReadContext& context, const YamlNode& node, const std::string& name,
                  const std::string& what, const std::string& path) {
  MapReader reader(context, node, what, path, "textures");
  if (node.kind != YamlNode::Kind::map) return;
  TextureDesc texture;
  texture.name = name;
  texture.where = node.where;
  reader.find("like");  // already resolved, see resolve_likes
  if (!read_by_type<TextureDesc>(reader, "type", "textures", texture, kTypes)) return;
  reader.finish();
  context.job.textures.push_back(std::move(texture));
}

bool read_texture_input(MapReader& reader, std::string_view key, const YamlNode& node,
                        std::string& texture) {
  if (node.kind == YamlNode::Kind::map && node.find("keys") == nullptr) {
    // Parentheses keep it apart from every name that a person can give.
    const std::string path = fmt::format("{}.{}", reader.path(), key);
    texture = "(" + path + ")";
    read_texture(reader.context(), node, texture, fmt::format("{} of {}", key, reader.what()),
                 path);
    return true;
  }
  if (node.kind == YamlNode::Kind::scalar && !looks_like_color(node.scalar) &&
      is_valid_name(node.scalar)) {
    texture = node.scalar;
    reader.context().names.push_back(
        {NameKind::texture, node.scalar, node.where, fmt::format("{} of {}", key, reader.what())});
    return true;
  }
  return false;
}

}  // namespace hyades::core
