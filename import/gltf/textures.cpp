#include "import/gltf/textures.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include "core/base/text.h"

namespace hyades::core {

namespace {

/// A sampler's wrapping mode (OpenGL's numbers, glTF 2.0, section 3.8.4.5).
const char* wrap_of(const JsonValue& sampler, const char* key) {
  switch (sampler.integer(key, 0, 65536, 10497)) {
    case 33071:
      return "clamp";
    case 33648:
      return "mirror";
    default:
      return "repeat";
  }
}

/// The ending of an image's file: by what it says it is, else by its first byte.
std::string ending_of(const GltfModel& model, const GltfImage& image) {
  if (image.type == "image/png") return ".png";
  if (image.type == "image/jpeg") return ".jpg";
  const Bytes& bytes =
      image.view >= 0 ? model.views[static_cast<size_t>(image.view)].bytes : image.bytes;
  if (bytes.size() > 4 && bytes.span()[0] == std::byte{0x89}) return ".png";
  if (bytes.size() > 4 && bytes.span()[0] == std::byte{0xFF}) return ".jpg";
  return {};
}

bool can_be_shown(const std::string& file) {
  const std::string name = lower_case(file);
  return name.ends_with(".png") || name.ends_with(".jpg") || name.ends_with(".jpeg");
}

}  // namespace

std::vector<std::string> image_file_names(const GltfModel& model) {
  Names names("image");
  std::vector<std::string> files;
  for (const GltfImage& image : model.images) {
    if (!image.file.empty()) {
      files.emplace_back();
      continue;
    }
    std::string name = safe_name(image.name, "image");
    if (can_be_shown(name)) name.resize(name.rfind('.'));
    files.push_back("images/" + names.add(name) + ending_of(model, image));
  }
  return files;
}

GltfTextures::GltfTextures(const GltfModel& model, const SceneRequest& request,
                           const std::vector<std::string>& image_files,
                           std::vector<std::string>& notes)
    : model_(model),
      request_(request),
      image_files_(image_files),
      notes_(notes),
      textures_(model.root(trouble_).list("textures")),
      samplers_(model.root(trouble_).list("samplers")),
      names_("texture", request.prefix) {}

std::string GltfTextures::file_of(int image) const {
  const std::string& made = image_files_[static_cast<size_t>(image)];
  return made.empty() ? request_.beside + model_.images[static_cast<size_t>(image)].file
                      : request_.made + made;
}

void GltfTextures::describe_sampler(int sampler, YamlMap& out) {
  if (sampler < 0) return;
  const JsonValue& value = samplers_[static_cast<size_t>(sampler)];
  const std::string u = wrap_of(value, "wrapS");
  const std::string v = wrap_of(value, "wrapT");
  if (u != v) {
    out.put("wrap", yaml_list({yaml_word(u), yaml_word(v)}));
  } else if (u != "repeat") {
    out.put("wrap", yaml_word(u));
  }
  // 9728 is NEAREST: the pixels are meant to be seen.
  if (value.integer("magFilter", 0, 65536, 9729) == 9728) out.put("filter", yaml_word("nearest"));
}

YamlPtr GltfTextures::transform_of(const JsonValue& info) {
  const JsonValue moved = info.member("extensions").member("KHR_texture_transform");
  if (!moved.exists()) return nullptr;
  Vec2 offset(0.0F);
  Vec2 scale(1.0F);
  moved.numbers("offset", std::span(&offset.x, 2));
  moved.numbers("scale", std::span(&scale.x, 2));
  const float angle = moved.number("rotation", 0.0F);
  if (offset == Vec2(0.0F) && scale == Vec2(1.0F) && angle == 0.0F) return nullptr;
  // With v downwards: u' = c su u + s sv v + ou, v' = -s su u + c sv v + ov, counter-clockwise as
  // one sees it (Khronos's README has the signs for v upwards; their issue 1563). Ours grows
  // upwards on both sides: v = 1 - w.
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  const std::array<float, 16> matrix = {c * scale.x, -s * scale.y,
                                        0,           s * scale.y + offset.x,  //
                                        s * scale.x, c * scale.y,
                                        0,           1.0F - c * scale.y - offset.y,  //
                                        0,           0,
                                        1,           0,  //
                                        0,           0,
                                        0,           1};
  return yaml_list({YamlMap{{"matrix", yaml_numbers(matrix)}}.node()});
}

std::string GltfTextures::name(const JsonValue& info, Meaning meaning, const std::string& channel) {
  if (!info.exists()) return {};
  const int index = info.required_index("index", textures_.size());
  if (index < 0) return {};
  const JsonValue& texture = textures_[static_cast<size_t>(index)];
  int64_t set = info.integer("texCoord", 0, 64, 0);
  set = info.member("extensions").member("KHR_texture_transform").integer("texCoord", 0, 64, set);
  const YamlPtr transform = transform_of(info);
  const int image = texture.index("source", model_.images.size());
  const int sampler = texture.index("sampler", samplers_.size());
  const std::string key = fmt::format(
      "{} {} {} {} {} {}", image, sampler, meaning == Meaning::color, channel, set,
      transform ? info.member("extensions").member("KHR_texture_transform").raw()->dump() : "");
  const auto known = made_.find(key);
  if (known != made_.end()) return known->second;
  std::string& name = made_[key];
  if (image < 0) {
    notes_.push_back(texture.place() + " has no picture that can be read and is left out");
    return name;
  }
  const std::string file = file_of(image);
  if (!can_be_shown(file)) {
    notes_.push_back(
        fmt::format("{} has picture '{}', which is neither PNG nor JPEG, and is left out",
                    texture.place(), file));
    return name;
  }
  if (set > 1) {
    notes_.push_back(fmt::format("{} wants TEXCOORD_{}; TEXCOORD_0 is taken", info.place(), set));
    set = 0;
  }
  std::string wanted = texture.text("name");
  if (wanted.empty()) wanted = model_.images[static_cast<size_t>(image)].name;
  if (can_be_shown(wanted)) wanted.resize(wanted.rfind('.'));
  if (wanted.empty()) wanted = "texture";
  if (!channel.empty()) wanted += "." + channel;
  name = names_.add(wanted);
  YamlMap out{{"type", yaml_word("image")}, {"file", yaml_text(file)}};
  if (meaning == Meaning::data) out.put("color_space", yaml_word("linear"));
  if (!channel.empty()) out.put("channel", yaml_word(channel));
  describe_sampler(sampler, out);
  const YamlPtr coordinates = yaml_word(set == 1 ? "uv1" : "uv");
  if (transform) {
    out.put("mapping", YamlMap{{"type", coordinates}, {"transform", transform}});
  } else if (set == 1) {
    out.put("mapping", coordinates);
  }
  section_.put(name, out);
  return name;
}

}  // namespace hyades::core
