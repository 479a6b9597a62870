#include <array>

#include "core/job/kinds.h"
#include "core/job/read_sections.h"
#include "core/job/read_texture_kinds.h"

namespace hyades::core {

namespace {

const std::array<std::string, 9> kMappings = {
    "default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"};
const std::array<std::string, 2> kSpaces = {"object", "world"};
const std::array<std::string, 3> kMetrics = {"euclidean", "manhattan", "chebyshev"};
const std::array<std::string, 4> kFeatures = {"f1", "f2", "edges", "id"};
const std::array<std::string, 5> kPatternShapes = {"linear", "radial", "cylindrical", "spherical",
                                                   "angular"};

bool projects(const std::string& type) {
  return type == "planar" || type == "spherical" || type == "cylindrical" || type == "triplanar";
}

void read_mapping_map(MapReader& map, TextureMapping& mapping) {
  map.choice("type", mapping.type, kMappings);
  map.choice("space", mapping.space, kSpaces);
  map.transform("transform", mapping.transform);
  map.animated("blend", mapping.blend, kUnitInterval);
  if (map.listing()) return;
  if (map.has("space") && !projects(mapping.type)) {
    map.complain(map.find("space")->where,
                 "space belongs to the mappings planar, spherical, cylindrical and triplanar");
  }
  if (map.has("blend") && mapping.type != "triplanar") {
    map.complain(map.find("blend")->where, "blend belongs to the mapping triplanar");
  }
}

void read_two_colors(MapReader& reader, TextureDesc& texture) {
  texture.a = ColorInput{Animated<Rgb>(Rgb(0.0F)), {}};
  texture.b = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  reader.color_input("a", texture.a, kNotNegative);
  reader.color_input("b", texture.b, kNotNegative);
  read_mapping(reader, texture);
}

/// `time`, 0 where it is absent.
void read_fourth_dimension(MapReader& reader, TextureDesc& texture) {
  texture.noise.time.emplace(0.0F);
  reader.animated("time", *texture.noise.time, kAnyNumber);
}

/// `time`, without which there are three dimensions.
void read_time(MapReader& reader, TextureDesc& texture) {
  if (reader.has("time") || reader.listing()) read_fourth_dimension(reader, texture);
}

void read_octaves(MapReader& reader, TextureDesc& texture, int octaves) {
  texture.noise.octaves = octaves;
  reader.integer("octaves", texture.noise.octaves, 1, 16);
  reader.animated("lacunarity", texture.noise.lacunarity, {1.0, 16.0});
  reader.animated("gain", texture.noise.gain, {0.0, 4.0});
}

void read_softness(MapReader& reader, TextureDesc& texture) {
  reader.animated("softness", texture.lines.softness, kUnitInterval);
}

}  // namespace

std::span<const std::string> mapping_names() { return kMappings; }
std::span<const std::string> mapping_space_names() { return kSpaces; }
std::span<const std::string> cell_metric_names() { return kMetrics; }
std::span<const std::string> cell_feature_names() { return kFeatures; }
std::span<const std::string> gradient_shape_names() { return kPatternShapes; }

void read_mapping(MapReader& reader, TextureDesc& texture) {
  const YamlNode* node = reader.find("mapping");
  const bool is_map = node != nullptr && node->kind == YamlNode::Kind::map;
  if (!is_map) reader.choice("mapping", texture.mapping.type, kMappings);
  if (is_map || reader.listing()) {
    reader.map("mapping", "textures.mapping",
               [&](MapReader& map) { read_mapping_map(map, texture.mapping); });
  }
  reader.animated_scale("scale", texture.mapping.scale, kAnyNumber);
  reader.animated_scale("offset", texture.mapping.offset, kAnyNumber);
}

void read_checker(MapReader& reader, TextureDesc& texture) { read_two_colors(reader, texture); }

void read_perlin(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  read_octaves(reader, texture, 1);
}

void read_perlin_4d(MapReader& reader, TextureDesc& texture) {
  read_perlin(reader, texture);
  read_fourth_dimension(reader, texture);
}

void read_fbm(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  read_octaves(reader, texture, 4);
}

void read_fbm_4d(MapReader& reader, TextureDesc& texture) {
  read_fbm(reader, texture);
  read_fourth_dimension(reader, texture);
}

void read_fractal(MapReader& reader, TextureDesc& texture) {
  read_fbm(reader, texture);
  read_time(reader, texture);
}

void read_layers(MapReader& reader, TextureDesc& texture) {
  read_fractal(reader, texture);
  texture.noise.distortion = Animated<float>(1.0F);
  reader.animated("distortion", texture.noise.distortion, kAnyNumber);
}

void read_cellular(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  read_time(reader, texture);
  reader.choice("metric", texture.cells.metric, kMetrics);
  reader.choice("feature", texture.cells.feature, kFeatures);
  reader.animated("jitter", texture.cells.jitter, kUnitInterval);
}

void read_brick(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  reader.animated("mortar", texture.lines.width, kUnitInterval);
  reader.animated("shift", texture.lines.shift, kUnitInterval);
  read_softness(reader, texture);
}

void read_lines(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  reader.animated("width", texture.lines.width, kUnitInterval);
  read_softness(reader, texture);
}

void read_gradient(MapReader& reader, TextureDesc& texture) {
  read_two_colors(reader, texture);
  reader.choice("shape", texture.shape, kPatternShapes);
}

}  // namespace hyades::core
