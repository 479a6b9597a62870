#include "core/job/read_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/udim.h"
#include "core/job/kinds.h"
#include "core/job/read_sections.h"
#include "core/job/read_texture_kinds.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

const std::array<std::string, 3> kColorSpaces = {"auto", "srgb", "linear"};
const std::array<std::string, 4> kWraps = {"repeat", "clamp", "mirror", "black"};
const std::array<std::string, 4> kFilters = {"trilinear", "anisotropic", "bilinear", "nearest"};

void read_constant(MapReader& reader, TextureDesc& texture) {
  reader.require("value", "a colour");
  reader.color_input("value", texture.a, kNotNegative);
}

/// One mode, or [along u, along v].
void read_wrap(MapReader& reader, TextureImage& image) {
  const YamlNode* node = reader.find("wrap");
  if (node == nullptr || node->kind != YamlNode::Kind::list) {
    reader.choice("wrap", image.wrap, kWraps);
    image.wrap_v = image.wrap;
    return;
  }
  const auto is_mode = [](const YamlPtr& item) {
    return item->kind == YamlNode::Kind::scalar &&
           std::find(kWraps.begin(), kWraps.end(), item->scalar) != kWraps.end();
  };
  if (node->list.size() != 2 || !std::all_of(node->list.begin(), node->list.end(), is_mode)) {
    reader.complain(node->where, "wrap is a list, expected one or two of " + join_names(kWraps) +
                                     ": [along u, along v]");
    return;
  }
  image.wrap = node->list[0]->scalar;
  image.wrap_v = node->list[1]->scalar;
}

void read_image(MapReader& reader, TextureDesc& texture) {
  TextureImage& image = texture.image;
  reader.require("file", "an image file");
  reader.file("file", image.file);
  reader.choice("color_space", image.color_space, kColorSpaces);
  read_wrap(reader, image);
  reader.choice("filter", image.filter, kFilters);
  reader.choice("channel", texture.channel, channel_names());
  read_mapping(reader, texture);
  if (is_udim(image.file) && reader.has("wrap")) {
    reader.complain(reader.find("wrap")->where,
                    "wrap is given, but the tiles of <UDIM> lie side by side and do not wrap");
  }
}

void read_vertex_color(MapReader& reader, TextureDesc& texture) {
  reader.choice("channel", texture.channel, channel_names());
}

const std::array<TypeRow<TextureDesc>, 30> kTextureTypes = {{
    {"constant", read_constant},
    {"image", read_image},
    {"vertex-color", read_vertex_color},
    {"checker", read_checker},
    {"brick", read_brick},
    {"stripes", read_lines},
    {"grid", read_lines},
    {"gradient", read_gradient},
    {"perlin3d", read_perlin},
    {"perlin4d", read_perlin_4d},
    {"fbm3d", read_fbm},
    {"fbm4d", read_fbm_4d},
    {"turbulence", read_fractal},
    {"ridged", read_fractal},
    {"marble", read_layers},
    {"wood", read_layers},
    {"cellular", read_cellular},
    {"scale", read_product},
    {"add", read_pair},
    {"divide", read_pair},
    {"min", read_pair},
    {"max", read_pair},
    {"mix", read_texture_mix},
    {"invert", read_invert},
    {"remap", read_remap},
    {"power", read_power},
    {"threshold", read_threshold},
    {"ramp", read_ramp},
    {"hue-saturation", read_hue_saturation},
    {"channel", read_channel},
}};

}  // namespace

std::vector<std::string> texture_types() { return type_names<TextureDesc>(kTextureTypes); }
std::span<const std::string> color_space_names() { return kColorSpaces; }
std::span<const std::string> wrap_names() { return kWraps; }
std::span<const std::string> texture_filter_names() { return kFilters; }

void read_textures(MapReader& top) {
  read_named(top, "textures", "texture", NameKind::texture, read_texture);
}

void read_texture(MapReader& reader, const std::string& name) {
  TextureDesc texture;
  texture.name = name;
  texture.where = reader.where();
  if (!read_by_type<TextureDesc>(reader, "type", "textures", texture, kTextureTypes)) return;
  reader.finish();
  reader.context().job.textures.push_back(std::move(texture));
}

bool read_texture_input(MapReader& reader, std::string_view key, const YamlNode& node,
                        std::string& texture) {
  if (node.kind == YamlNode::Kind::map && node.find("keys") == nullptr) {
    // Parentheses keep it apart from every name that a person can give.
    const std::string path = fmt::format("{}.{}", reader.path(), key);
    texture = "(" + path + ")";
    MapReader in_place(reader.context(), node, fmt::format("{} of {}", key, reader.what()), path,
                       "textures");
    in_place.leave_to_others("like");
    read_texture(in_place, texture);
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
