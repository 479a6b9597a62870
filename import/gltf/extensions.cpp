#include "import/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <set>

namespace hyades::core {

namespace {

/// Those that are read, wholly or as far as docs/import.md says.
constexpr std::array<const char*, 20> kKnown = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
};

bool is_known(const std::string& name) {
  return std::any_of(kKnown.begin(), kKnown.end(), [&](const char* k) { return name == k; });
}

}  // namespace

Status check_extensions(const JsonValue& root, std::vector<std::string>& notes) {
  std::set<std::string> seen;
  for (const JsonValue& item : root.list("extensionsRequired")) {
    const std::string name = item.as_text();
    if (!is_known(name)) {
      return Error{"it requires the extension " + name + ", which is not supported"};
    }
  }
  for (const JsonValue& item : root.list("extensionsUsed")) {
    const std::string name = item.as_text();
    if (!is_known(name) && seen.insert(name).second) {
      notes.push_back("extension " + name + " is not supported and left out");
    }
  }
  return {};
}

}  // namespace hyades::core
