#include <array>

#include "core/base/elementary.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

void read_aperture(MapReader& reader, CameraDesc& camera) {
  reader.animated("radius", camera.aperture_radius, kNotNegative);
  const bool has_focal_length = camera.type == "perspective";
  if (const YamlNode* node = reader.find("f_stop"); node != nullptr && !has_focal_length) {
    reader.complain(node->where,
                    "aperture has f_stop, but " + camera.type +
                        " cameras have no focal length that it could divide, expected radius");
  } else if (node != nullptr) {
    Animated<float> f_stop(1.0F);
    reader.animated("f_stop", f_stop, kPositive);
    camera.f_stop = f_stop;
    if (reader.has("radius")) {
      reader.complain(node->where, "aperture has both radius and f_stop, expected one of them");
    }
  }
  reader.integer("blades", camera.aperture_blades, 0, 64);
  if (camera.aperture_blades == 1 || camera.aperture_blades == 2) {
    reader.mismatch("blades", *reader.find("blades"), "0 (round) or 3 to 64");
  }
  reader.animated("rotation", camera.aperture_rotation, kAnyNumber);
}

/// Stops by which a camera so set makes pictures brighter. The exposure value for film of speed S
/// is EV100 = log2(N^2 / t * 100 / S), and a luminance of 1.2 * 2^EV100 [cd/m^2] just fills the
/// picture (saturation-based speed, ISO 12232; Lagarde & de Rousiers 2014, "Moving Frostbite to
/// Physically Based Rendering", section 5.1).
void read_exposure(MapReader& reader) {
  reader.map("exposure", "camera.exposure", [](MapReader& map) {
    float iso = 100.0F;
    float shutter = 1.0F / 125.0F;
    float f_number = 16.0F;
    float efficacy = 97.4F;
    map.number("iso", iso, {1.0, 1e7});
    map.number("shutter", shutter, {1e-9, 1e6});
    map.number("f_number", f_number, {0.01, 1e4});
    map.number("efficacy", efficacy, {1e-3, 683.0});
    if (map.listing()) return;
    const float least = 1.2F * f_number * f_number / shutter * 100.0F / iso;
    map.context().exposure = log2(efficacy / least);
  });
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

void read_place(MapReader& reader, CameraDesc& camera) {
  reader.animated("look_from", camera.look_from, kAnyNumber);
  reader.animated("look_at", camera.look_at, kAnyNumber);
  reader.direction("up", camera.up);
  reader.keep_apart("look_from", camera.look_from, "look_at", camera.look_at);
}

void read_lens(MapReader& reader, CameraDesc& camera) {
  reader.map("aperture", "camera.aperture",
             [&](MapReader& aperture) { read_aperture(aperture, camera); });
  read_focus(reader, camera);
}

void read_perspective(MapReader& reader, CameraDesc& camera) {
  read_place(reader, camera);
  reader.animated("fov", camera.fov, {0.0, 180.0, true, true});
  reader.animated("shift", camera.shift, {-100.0, 100.0});
  read_lens(reader, camera);
}

void read_orthographic(MapReader& reader, CameraDesc& camera) {
  read_place(reader, camera);
  reader.animated("height", camera.height, kPositive);
  read_lens(reader, camera);
}

const std::array<TypeRow<CameraDesc>, 3> kCameras = {{
    {"perspective", read_perspective},
    {"orthographic", read_orthographic},
    {"equirectangular", read_place},
}};

}  // namespace

void read_camera(MapReader& top, CameraDesc& camera) {
  top.map("camera", "camera", [&](MapReader& reader) {
    read_exposure(reader);
    reader.context().in_shutter = true;
    read_by_type<CameraDesc>(reader, "type", "camera", camera, kCameras);
    reader.context().in_shutter = false;
  });
}

}  // namespace hyades::core
