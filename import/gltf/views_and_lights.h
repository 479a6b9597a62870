#pragma once

#include "import/gltf/objects.h"
#include "import/names.h"

namespace hyades::core {

/// Sections `camera` and `film` of the scene's first camera; further ones are noted.
struct GltfCamera {
  YamlMap camera;
  YamlMap film;
};

GltfCamera write_camera(const GltfStage& stage, const JsonValue& root);

/// KHR_lights_punctual as a job's lights. Candela and lux become watts by 683 lm/W, as Blender has
/// it: a light of I cd is one of 4 pi I / 683 W, one of E lx has E / 683 W/m^2.
YamlMap write_lights(const GltfStage& stage, const JsonValue& root);

}  // namespace hyades::core
