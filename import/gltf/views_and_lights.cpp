#include "import/gltf/views_and_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hyades::core {

namespace {

constexpr float kLumensPerWatt = 683.0F;
constexpr float kDegrees = 180.0F / kPi;
constexpr int kFilmHeight = 720;

Vec3 origin_of(const Mat4& m) { return Vec3(m[3]); }

/// A unit vector, or `otherwise` for a node that is scaled to nothing.
Vec3 direction_of(const Vec3& v, const Vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-20F ? v / length : otherwise;
}

Vec3 forward_of(const Mat4& m) {
  return direction_of(Vec3(0.0F) - Vec3(m[2]), Vec3(0.0F, 0.0F, -1.0F));
}

/// A film of this width over height.
YamlMap film_of(float aspect) {
  if (!(aspect > 0.0F)) return {};
  const float width = std::clamp(kFilmHeight * aspect, 1.0F, 8192.0F);
  return YamlMap{
      {"size", yaml_list({yaml_integer(std::lround(width)), yaml_integer(kFilmHeight)})}};
}

void write_lens(const JsonValue& value, GltfCamera& out) {
  const JsonValue perspective = value.member("perspective");
  const JsonValue parallel = value.member("orthographic");
  const std::string type = value.text("type");
  if (type == "orthographic") {
    out.camera.put("type", yaml_word("orthographic"));
    const float ymag = std::fabs(parallel.number("ymag", 1.0F));
    const float xmag = std::fabs(parallel.number("xmag", ymag));
    if (!(ymag > 0.0F) || !(xmag > 0.0F)) {
      parallel.complain("has xmag or ymag 0");
      return;
    }
    out.camera.put("height", yaml_number(2.0F * ymag));
    out.film = film_of(xmag / ymag);
  } else if (type == "perspective") {
    const float fov = perspective.number("yfov", 0.8F) * kDegrees;
    if (!(fov > 0.0F && fov < 180.0F)) {
      perspective.member("yfov").complain("is not an angle between 0 and pi");
      return;
    }
    out.camera.put("fov", yaml_number(fov));
    out.film = film_of(perspective.number("aspectRatio", 0.0F));
  } else {
    value.member("type").complain("is '" + type + "', expected perspective or orthographic");
  }
}

void write_place(const GltfStage& stage, int node, YamlMap& camera) {
  const auto vector = [&](auto&& at) {
    return moving_vector(stage.model, stage.clip, node, stage.frames, at);
  };
  camera.put("look_from", vector(origin_of));
  camera.put("look_at", vector([](const Mat4& m) { return origin_of(m) + forward_of(m); }));
  camera.put(
      "up", vector([](const Mat4& m) { return direction_of(Vec3(m[1]), Vec3(0.0F, 1.0F, 0.0F)); }));
}

void write_cone(const GltfStage& stage, const JsonValue& light, int node, YamlMap& out) {
  const JsonValue cone = light.member("spot");
  const float outer = std::clamp(cone.number("outerConeAngle", kPi / 4.0F), 1e-3F, kPi / 2.0F);
  const float inner = std::clamp(cone.number("innerConeAngle", 0.0F), 0.0F, outer);
  out.put("look_at", moving_vector(stage.model, stage.clip, node, stage.frames,
                                   [](const Mat4& m) { return origin_of(m) + forward_of(m); }));
  out.put("angle", yaml_number(outer * kDegrees));
  out.put("blend", yaml_number(1.0F - inner / outer));
}

YamlMap light_of(const GltfStage& stage, const JsonValue& light, int node) {
  const std::string type = light.text("type");
  Rgb color(1.0F);
  light.numbers("color", std::span(&color.x, 3));
  color = glm::max(color, Rgb(0.0F));
  const float intensity = light.number("intensity", 1.0F, 0.0F, 1e12F) / kLumensPerWatt;
  YamlMap out;
  if (type == "directional") {
    out.put("type", yaml_word("sun")).put("color", yaml_vector(color));
    out.put("direction", moving_vector(stage.model, stage.clip, node, stage.frames, forward_of));
    out.put("irradiance", yaml_number(intensity)).put("angle", yaml_number(0.0F));
    return out;
  }
  if (type != "point" && type != "spot") {
    light.member("type").complain("is '" + type + "', expected point, spot or directional");
    return out;
  }
  out.put("type", yaml_word(type)).put("color", yaml_vector(color));
  out.put("at", moving_vector(stage.model, stage.clip, node, stage.frames, origin_of));
  out.put("power", yaml_number(4.0F * kPi * intensity));
  if (light.has("range")) {
    stage.notes.push_back(light.place() + ".range is left out: light ends nowhere");
  }
  if (type == "spot") write_cone(stage, light, node, out);
  return out;
}

}  // namespace

GltfCamera write_camera(const GltfStage& stage, const JsonValue& root) {
  GltfCamera out;
  const std::vector<JsonValue> cameras = root.list("cameras");
  for (const int node : stage.model.order) {
    const int index = stage.model.nodes[static_cast<size_t>(node)].camera;
    if (index < 0) continue;
    if (!out.camera.empty()) {
      stage.notes.push_back(fmt::format("camera of nodes[{}] is left out: a job has one", node));
      continue;
    }
    write_lens(cameras[static_cast<size_t>(index)], out);
    write_place(stage, node, out.camera);
  }
  return out;
}

YamlMap write_lights(const GltfStage& stage, const JsonValue& root) {
  const std::vector<JsonValue> lights =
      root.member("extensions").member("KHR_lights_punctual").list("lights");
  Names names("light", stage.request.prefix);
  YamlMap out;
  for (const int index : stage.model.order) {
    const GltfNode& node = stage.model.nodes[static_cast<size_t>(index)];
    if (node.light < 0) continue;
    const JsonValue& light = lights[static_cast<size_t>(node.light)];
    const std::string wanted = !node.name.empty() ? node.name : light.text("name");
    const YamlMap made = light_of(stage, light, index);
    if (!made.empty()) out.put(names.add(wanted), made);
  }
  return out;
}

}  // namespace hyades::core
