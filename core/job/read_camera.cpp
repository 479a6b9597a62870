#include <optional>
#include <string>
#include <string_view>

#include "core/base/elementary.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

void check_keys(MapReader& reader, ApertureDesc& aperture) {
  if (reader.has("f_stop") && reader.has("radius")) {
    reader.complain(reader.where_of("f_stop"),
                    "aperture has both radius and f_stop, expected one of them");
  }
  if (aperture.blades == 1 || aperture.blades == 2) {
    reader.mismatch("blades", *reader.find("blades"), "0 (round) or 3 to 64");
  }
}

/// Stops by which a camera so set makes pictures brighter. The exposure value for film of speed S
/// is EV100 = log2(N^2 / t * 100 / S), and a luminance of 1.2 * 2^EV100 [cd/m^2] just fills the
/// picture (saturation-based speed, ISO 12232; Lagarde & de Rousiers 2014, "Moving Frostbite to
/// Physically Based Rendering", section 5.1).
void check_keys(MapReader& reader, ExposureDesc& exposure) {
  const float n = exposure.f_number;
  const float least = 1.2F * n * n / exposure.shutter * 100.0F / exposure.iso;
  reader.context().exposure = log2(exposure.efficacy / least);
}

void check_keys(MapReader& reader, CameraDesc& camera) {
  if (!camera.aperture.f_stop || camera.type == "perspective") return;
  reader.complain(reader.node().find("aperture")->value->find("f_stop")->value->where,
                  "aperture has f_stop, but " + camera.type +
                      " cameras have no focal length that it could divide, expected radius");
}

void MapReader::focus(std::string_view key, std::optional<Animated<float>>& distance,
                      std::string& object, SourceLocation& where) {
  if (listing())
    tell(key, {.takes = "number, animated, or an object's name", .range = kPositive.in("length")});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  double number = 0.0;
  const bool name = node->kind == YamlNode::Kind::scalar && !node->scalar.starts_with('=') &&
                    !parse_number(node->scalar, number);
  if (!name) return animated(key, distance, kPositive.in("length"));
  name_of(key, object, NameKind::object);
  where = node->where;
}

void read_camera(MapReader& top, CameraDesc& camera) {
  top.map("camera", "camera", [&](MapReader& reader) {
    ExposureDesc exposure;
    reader.map("exposure", "camera.exposure", exposure);
    reader.context().in_shutter = true;
    read_typed(reader, "camera", camera, kCameraTypes);
    reader.context().in_shutter = false;
  });
}

}  // namespace hyades::core
