#include "import/pbrt/texture_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/image/read_image.h"
#include "import/pbrt/read_parameters.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {
namespace {

/// y becomes z: our spheres and cylinders stand around y, pbrt's around z.
Mat4d y_for_z() { return rotation(-90.0, Vec3d(1.0, 0.0, 0.0)); }

YamlPtr typed(const char* type, std::initializer_list<std::pair<std::string_view, YamlPtr>> more) {
  YamlMap map{{"type", yaml_word(type)}};
  for (const auto& [key, node] : more) map.put(key, node);
  return map.node();
}

}  // namespace

TextureKinds::TextureKinds(Textures& textures, Context& context, const NamedEntity& entity,
                           bool floats)
    : textures_(textures),
      context_(context),
      entity_(entity),
      floats_(floats),
      reader_(entity.parameters, entity.place, context.report) {}

void TextureKinds::note(const std::string& what) { context_.report.note(entity_.place, what); }

YamlPtr TextureKinds::make() {
  using Maker = YamlPtr (TextureKinds::*)();
  struct Row {
    const char* name;
    Maker maker;
  };
  static const std::vector<Row> rows = {
      {"bilerp", &TextureKinds::bilerp},     {"checkerboard", &TextureKinds::checkerboard},
      {"constant", &TextureKinds::constant}, {"directionmix", &TextureKinds::direction_mix},
      {"dots", &TextureKinds::dots},         {"fbm", &TextureKinds::fbm},
      {"imagemap", &TextureKinds::image},    {"marble", &TextureKinds::marble},
      {"mix", &TextureKinds::mix},           {"ptex", &TextureKinds::ptex},
      {"scale", &TextureKinds::scale},       {"windy", &TextureKinds::windy},
      {"wrinkled", &TextureKinds::wrinkled},
  };
  std::vector<std::string> names;
  for (const Row& row : rows) {
    names.emplace_back(row.name);
    if (entity_.type != row.name) continue;
    YamlPtr made = (this->*row.maker)();
    reader_.note_unused();
    return made;
  }
  context_.report.error(entity_.place, "there is no texture '" + entity_.type + "'" +
                                           did_you_mean(entity_.type, names));
  return nullptr;
}

YamlPtr TextureKinds::value(const char* name, float otherwise) {
  return floats_ ? textures_.number(reader_, name, otherwise)
                 : textures_.color(reader_, name, Rgb(otherwise));
}

YamlPtr TextureKinds::constant() { return typed("constant", {{"value", value("value", 1.0F)}}); }

YamlPtr TextureKinds::scale() {
  YamlPtr factor = textures_.number(reader_, "scale", 1.0F);
  const auto number = plain_number(factor);
  if (number && *number < 0.0F) {
    note("a texture is multiplied by a number below 0: it is black");
    factor = yaml_number(0.0F);
  }
  return typed("scale", {{"input", value("tex", 1.0F)}, {"factor", factor}});
}

YamlPtr TextureKinds::mix() {
  return typed("mix", {{"a", value("tex1", 0.0F)},
                       {"b", value("tex2", 1.0F)},
                       {"amount", textures_.number(reader_, "amount", 0.5F)}});
}

YamlPtr TextureKinds::direction_mix() {
  note("a mixture by direction becomes one of equal parts");
  reader_.triple("vector3", "dir", Vec3d(0.0, 1.0, 0.0));
  return typed("mix", {{"a", value("tex1", 0.0F)}, {"b", value("tex2", 1.0F)}});
}

YamlPtr TextureKinds::bilerp() {
  const auto across = [&](const char* low, float low_value, const char* high, float high_value) {
    YamlMap along{{"type", yaml_word("gradient")}};
    put_plane_mapping(along);
    // The other axis: a quarter turn brings v to where u is looked up.
    YamlMap turned{{"type", yaml_word("gradient")}};
    turned.put("mapping", YamlMap{{"type", yaml_word("uv")},
                                  {"transform",
                                   yaml_list({YamlMap{{"rotate_z", yaml_number(-90.0F)}}.node()})}}
                              .node());
    return typed(
        "mix",
        {{"a", value(low, low_value)}, {"b", value(high, high_value)}, {"amount", turned.node()}});
  };
  YamlMap along{{"type", yaml_word("gradient")}};
  put_plane_mapping(along);
  return typed("mix", {{"a", across("v00", 0.0F, "v01", 1.0F)},
                       {"b", across("v10", 0.0F, "v11", 1.0F)},
                       {"amount", along.node()}});
}

YamlPtr TextureKinds::checkerboard() {
  YamlMap out{{"type", yaml_word("checker")}};
  out.put("a", value("tex1", 1.0F)).put("b", value("tex2", 0.0F));
  if (reader_.integer("dimension", 2) == 3) {
    put_space_mapping(out);
  } else {
    put_plane_mapping(out);
  }
  return out.node();
}

YamlPtr TextureKinds::dots() {
  note("dots lie in a regular grid");
  YamlMap cells{{"type", yaml_word("cellular")}, {"jitter", yaml_number(0.0F)}};
  put_plane_mapping(cells);
  // Half of the cells have a dot of radius 0.35: as much of a surface has one of radius 0.2475 in
  // every cell.
  const YamlPtr inside = typed(
      "invert",
      {{"input", typed("threshold", {{"input", cells.node()}, {"level", yaml_number(0.2475F)}})}});
  return typed("mix",
               {{"a", value("outside", 0.0F)}, {"b", value("inside", 1.0F)}, {"amount", inside}});
}

YamlPtr TextureKinds::ptex() {
  note("Ptex is not read: grey of 0.5 stands in");
  reader_.text("filename");
  reader_.text("encoding");
  reader_.number("scale", 1.0F);
  return typed("constant", {{"value", yaml_number(0.5F)}});
}

TextureKinds::FloatOf TextureKinds::float_of(const std::string& file) const {
  // What cannot be read is told when the job asks for it.
  const auto bytes = context_.loaded.files.find(file);
  if (bytes == context_.loaded.files.end()) return FloatOf::grey;
  const auto picture = read_image(bytes->second, file, ColorSpace::linear);
  if (!picture || picture->find_channel("R") < 0) return FloatOf::grey;
  const auto channels = static_cast<size_t>(picture->channel_count());
  const int alpha = picture->find_channel("A");
  bool colored = false;
  for (size_t at = 0; at < picture->data.size(); at += channels) {
    const float* pixel = &picture->data[at];
    if (alpha >= 0 && pixel[alpha] != 1.0F) return FloatOf::alpha;
    colored = colored || pixel[0] != pixel[1] || pixel[1] != pixel[2];
  }
  return colored ? FloatOf::mean : FloatOf::grey;
}

YamlPtr TextureKinds::image() {
  const std::string reference = reader_.text("filename");
  if (reference.empty()) {
    context_.report.error(entity_.place, "a texture of type imagemap needs a filename");
    return nullptr;
  }
  const std::string file = context_.beside(reference, entity_.place);
  if (file.empty()) return nullptr;
  YamlMap out{{"type", yaml_word("image")}, {"file", yaml_text(file)}};
  const std::string encoding = reader_.text("encoding", "sRGB");
  float gamma = 1.0F;
  if (encoding == "linear") {
    out.put("color_space", yaml_word("linear"));
  } else if (encoding.starts_with("gamma ")) {
    out.put("color_space", yaml_word("linear"));
    gamma = static_cast<float>(number_of(std::string_view(encoding).substr(6)).value_or(2.2));
  } else if (encoding != "sRGB") {
    note("the encoding '" + encoding + "' is not known: sRGB is taken");
  }
  const std::string wrap = reader_.text("wrap", "repeat");
  if (wrap == "black" || wrap == "clamp") {
    out.put("wrap", yaml_word(wrap));
  } else if (wrap != "repeat") {
    note("the wrap mode '" + wrap + "' becomes repeat");
  }
  const std::string filter = reader_.text("filter", "bilinear");
  if (filter == "point") {
    out.put("filter", yaml_word("nearest"));
  } else if (filter == "ewa" || filter == "EWA") {
    out.put("filter", yaml_word("anisotropic"));
  }
  reader_.number("maxanisotropy", 8.0F);
  put_plane_mapping(out);
  const auto of_channel = [&](const char* channel) {
    YamlMap image = out;
    if (channel != nullptr) image.put("channel", yaml_word(channel));
    YamlPtr node = image.node();
    if (gamma == 1.0F) return node;
    return typed("power", {{"input", node}, {"exponent", yaml_number(gamma)}});
  };
  YamlPtr made;
  if (!floats_) {
    made = of_channel(nullptr);
  } else if (const FloatOf of = float_of(reference); of == FloatOf::mean) {
    const auto sum = [](const YamlPtr& a, const YamlPtr& b) {
      return typed("add", {{"a", a}, {"b", b}});
    };
    const YamlPtr all = sum(sum(of_channel("red"), of_channel("green")), of_channel("blue"));
    made = typed("scale", {{"input", all}, {"factor", yaml_number(1.0F / 3.0F)}});
  } else {
    made = of_channel(of == FloatOf::alpha ? "alpha" : "luminance");
  }
  const float scale = reader_.number("scale", 1.0F);
  if (scale != 1.0F)
    made = typed("scale", {{"input", made}, {"factor", yaml_number(std::max(scale, 0.0F))}});
  if (reader_.flag("invert", false)) made = typed("invert", {{"input", made}});
  return made;
}

YamlPtr TextureKinds::fbm() {
  const int octaves = std::clamp(reader_.integer("octaves", 8), 1, 16);
  const float roughness = std::clamp(reader_.number("roughness", 0.5F), 0.0F, 4.0F);
  // Ours is the mean of the octaves brought to 0..1; this one their sum, around 0.
  float sum = 0.0F;
  for (int i = 0; i < octaves; ++i) sum += std::pow(roughness, static_cast<float>(i));
  YamlMap noise{{"type", yaml_word("fbm3d")},
                {"octaves", yaml_integer(octaves)},
                {"lacunarity", yaml_number(1.99F)},
                {"gain", yaml_number(roughness)}};
  put_space_mapping(noise);
  note("noise has another pattern of the same kind");
  return typed("remap", {{"input", noise.node()},
                         {"to_low", yaml_number(-sum)},
                         {"to_high", yaml_number(sum)},
                         {"ends", yaml_word("open")}});
}

YamlPtr TextureKinds::wrinkled() {
  const int octaves = std::clamp(reader_.integer("octaves", 8), 1, 16);
  const float roughness = std::clamp(reader_.number("roughness", 0.5F), 0.0F, 4.0F);
  float sum = 0.0F;
  for (int i = 0; i < octaves; ++i) sum += std::pow(roughness, static_cast<float>(i));
  YamlMap noise{{"type", yaml_word("turbulence")},
                {"octaves", yaml_integer(octaves)},
                {"lacunarity", yaml_number(1.99F)},
                {"gain", yaml_number(roughness)}};
  put_space_mapping(noise);
  note("noise has another pattern of the same kind");
  return typed("scale", {{"input", noise.node()}, {"factor", yaml_number(sum)}});
}

YamlPtr TextureKinds::windy() {
  // Waves of six octaves, as strong as a slow wind of three says.
  YamlMap wind{{"type", yaml_word("turbulence")},
               {"octaves", yaml_integer(3)},
               {"scale", yaml_number(0.1F)}};
  put_space_mapping(wind);
  YamlMap waves{{"type", yaml_word("fbm3d")}, {"octaves", yaml_integer(6)}};
  put_space_mapping(waves);
  note("noise has another pattern of the same kind");
  return typed("scale", {{"input", waves.node()}, {"factor", wind.node()}});
}

YamlPtr TextureKinds::marble() {
  const int octaves = std::clamp(reader_.integer("octaves", 8), 1, 16);
  const float roughness = std::clamp(reader_.number("roughness", 0.5F), 0.0F, 4.0F);
  const float scale = reader_.number("scale", 1.0F);
  const float variation = reader_.number("variation", 0.2F);
  note("marble has layers of the same colours in another pattern");
  YamlMap noise{{"type", yaml_word("marble")},
                {"octaves", yaml_integer(octaves)},
                {"gain", yaml_number(roughness)},
                {"distortion", yaml_number(variation)},
                {"scale", yaml_number(scale / kPi)}};
  put_space_mapping(noise);
  const YamlPtr stops = YamlMap{{"0", yaml_vector(Rgb(0.58F, 0.58F, 0.6F))},
                                {"0.4", yaml_vector(Rgb(0.5F, 0.5F, 0.5F))},
                                {"0.7", yaml_vector(Rgb(0.6F, 0.59F, 0.58F))},
                                {"1", yaml_vector(Rgb(0.2F, 0.2F, 0.33F))}}
                            .node();
  return typed("scale", {{"input", typed("ramp", {{"input", noise.node()}, {"stops", stops}})},
                         {"factor", yaml_number(1.5F)}});
}

Mat4d TextureKinds::to_texture() const {
  return glm::inverse(context_.to_job * entity_.to_world.at[0]);
}

void TextureKinds::put_space_mapping(YamlMap& out) {
  YamlMap mapping{{"type", yaml_word("world")}};
  if (YamlPtr steps = transform_node(to_texture())) mapping.put("transform", steps);
  out.put("mapping", mapping);
}

void TextureKinds::put_plane_mapping(YamlMap& out) {
  const std::string kind = reader_.text("mapping", "uv");
  const float du = reader_.number("udelta", 0.0F);
  const float dv = reader_.number("vdelta", 0.0F);
  if (kind == "uv") {
    const float u = reader_.number("uscale", 1.0F);
    const float v = reader_.number("vscale", 1.0F);
    if (u != 1.0F || v != 1.0F) out.put("scale", yaml_numbers(std::array<float, 2>{u, v}));
    if (du != 0.0F || dv != 0.0F) out.put("offset", yaml_numbers(std::array<float, 2>{du, dv}));
    return;
  }
  Mat4d place = to_texture();
  if (kind == "planar") {
    const Vec3d s = reader_.triple("vector3", "v1", Vec3d(1.0, 0.0, 0.0));
    const Vec3d t = reader_.triple("vector3", "v2", Vec3d(0.0, 1.0, 0.0));
    const Vec3d n = glm::cross(s, t);
    Mat4d flat(1.0);
    for (int c = 0; c < 3; ++c) flat[c] = glm::dvec4(s[c], t[c], n[c], 0.0);
    flat[3] = glm::dvec4(du, dv, 0.0, 1.0);
    place = flat * place;
  } else if (kind == "cylindrical") {
    // u begins at -x.
    place = rotation(180.0, Vec3d(0.0, 1.0, 0.0)) * y_for_z() * place;
  } else if (kind == "spherical") {
    place = y_for_z() * place;
    note("in spherical mappings u goes around and v up");
  } else {
    context_.report.error(entity_.place, "there is no mapping '" + kind + "'");
    return;
  }
  YamlMap mapping{{"type", yaml_word(kind)}, {"space", yaml_word("world")}};
  if (YamlPtr steps = transform_node(place)) mapping.put("transform", steps);
  out.put("mapping", mapping);
}

}  // namespace hyades::core::pbrt
