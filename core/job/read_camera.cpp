#include <array>

#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

void read_aperture(MapReader& reader, CameraDesc& camera) {
  reader.animated("radius", camera.aperture_radius, kNotNegative);
  if (reader.find("f_stop") != nullptr) {
    Animated<float> f_stop(1.0F);
    reader.animated("f_stop", f_stop, kPositive);
    camera.f_stop = f_stop;
    if (reader.has("radius")) {
      reader.complain(reader.find("f_stop")->where,
                      "aperture has both radius and f_stop, expected one of them");
    }
  }
  reader.integer("blades", camera.aperture_blades, 0, 64);
  if (camera.aperture_blades == 1 || camera.aperture_blades == 2) {
    reader.mismatch("blades", *reader.find("blades"), "0 (round) or 3 to 64");
  }
  reader.number("rotation", camera.aperture_rotation, kAnyNumber);
}

/// A distance (number, expression, keys) or the name of an object.
void read_focus(MapReader& reader, CameraDesc& camera) {
  const YamlNode* node = reader.find("focus");
  if (node == nullptr) return;
  double number = 0.0;
  const bool name = node->kind == YamlNode::Kind::scalar && !node->scalar.starts_with('=') &&
                    !parse_number(node->scalar, number);
  if (name) {
    reader.name_of("focus", camera.focus_object, NameKind::object);
    camera.focus_where = node->where;
    return;
  }
  Animated<float> distance(1.0F);
  reader.animated("focus", distance, kPositive);
  camera.focus_distance = distance;
}

void read_perspective(MapReader& reader, CameraDesc& camera) {
  reader.animated("look_from", camera.look_from, kAnyNumber);
  reader.animated("look_at", camera.look_at, kAnyNumber);
  reader.direction("up", camera.up);
  reader.animated("fov", camera.fov, {0.0, 180.0, true, true});
  reader.map("aperture", "camera.aperture",
             [&](MapReader& aperture) { read_aperture(aperture, camera); });
  read_focus(reader, camera);
  reader.keep_apart("look_from", camera.look_from, "look_at", camera.look_at);
}

const std::array<TypeRow<CameraDesc>, 3> kCameras = {{
    {"perspective", read_perspective},
    {"orthographic", nullptr},
    {"panoramic", nullptr},
}};

}  // namespace

void read_camera(MapReader& top, CameraDesc& camera) {
  top.map("camera", "camera", [&](MapReader& reader) {
    reader.context().in_shutter = true;
    read_by_type<CameraDesc>(reader, "type", "camera", camera, kCameras);
    reader.context().in_shutter = false;
  });
}

}  // namespace hyades::core
