#pragma once

#include <string>
#include <vector>

#include "import/gltf/textures.h"
#include "import/tinted.h"

/// The parts of a glTF material, each as keys of a job's principled material.
namespace hyades::core {

/// Where the parts of one material are written to.
struct MaterialSheet {
  const JsonValue& value;  ///< the material
  GltfTextures& textures;
  std::vector<std::string>& notes;
  YamlMap out{};
  bool colored = false;  ///< the colours of the vertices count
  YamlPtr opacity{};     ///< null: 1
  YamlMap mirror{};      ///< what `out` is mixed with; empty: nothing
  YamlPtr mirror_amount{};

  JsonValue extension(const char* name) const { return value.member("extensions").member(name); }
  void note(const std::string& what) const { notes.push_back(value.place() + " " + what); }
};

/// The base colour: a factor, a texture (if any), and the colours of the vertices.
YamlPtr base_color_of(MaterialSheet& sheet, const Rgb& factor, const JsonValue& texture);

/// A colour `key` of `from`, three numbers, each held within 0..most.
Rgb color_of(const JsonValue& from, const char* key, const Rgb& absent, float most);

/// base_color, metallic, roughness; `opacity` by the alpha mode.
void write_base(MaterialSheet& sheet);
/// KHR_materials_pbrSpecularGlossiness, in place of those where it is there.
void write_specular_glossiness(MaterialSheet& sheet);
void write_opacity(MaterialSheet& sheet, float alpha, const JsonValue& texture);
/// KHR_materials_ior, _specular.
void write_specular(MaterialSheet& sheet);
/// KHR_materials_anisotropy.
void write_anisotropy(MaterialSheet& sheet);
/// KHR_materials_sheen.
void write_sheen(MaterialSheet& sheet);
/// KHR_materials_transmission, _diffuse_transmission; thin walls where there is no volume.
void write_transmission(MaterialSheet& sheet);
/// Whether light goes into what the surface bounds or through it: then `doubleSided` says nothing
/// (KHR_materials_volume: no effect on the boundaries of volumes).
bool lets_light_in(const MaterialSheet& sheet);
/// The medium of KHR_materials_volume as its keys; empty where light goes through unharmed.
YamlMap volume_of(const MaterialSheet& sheet);

/// The normal map `key` of a material; null where there is none.
YamlPtr normal_map_of(MaterialSheet& sheet, const JsonValue& info);

}  // namespace hyades::core
