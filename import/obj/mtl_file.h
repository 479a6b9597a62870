#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "import/obj/mtl_map.h"

namespace hyades::core {

/// A material of an MTL file (Wavefront, "MTL material format", 1995; the keys of physically based
/// shading as exporters have written them since 2015). What the file does not say is not there.
struct MtlMaterial {
  std::string name;
  int line = 0;                         ///< of its newmtl
  std::optional<Rgb> diffuse;           ///< Kd, 0..1
  std::optional<Rgb> specular;          ///< Ks, 0..1
  std::optional<Rgb> filter;            ///< Tf: tint of what goes through, 0..1
  Rgb emission{0.0F};                   ///< Ke
  std::optional<float> exponent;        ///< Ns of Phong's highlights, at least 0
  std::optional<float> index;           ///< Ni, above 0
  float dissolve = 1.0F;                ///< d, or 1 - Tr: how much of it is there, 0..1
  std::optional<int> illumination;      ///< illum: which of the classic models
  std::optional<float> roughness;       ///< Pr, 0..1
  std::optional<float> metallic;        ///< Pm
  std::optional<float> sheen;           ///< Ps
  std::optional<float> coat;            ///< Pc
  std::optional<float> coat_roughness;  ///< Pcr
  std::optional<float> anisotropy;      ///< aniso
  std::optional<float> rotation;        ///< anisor, turns
  MtlMap diffuse_map;                   ///< map_Kd
  MtlMap specular_map;                  ///< map_Ks
  MtlMap exponent_map;                  ///< map_Ns
  MtlMap emission_map;                  ///< map_Ke
  MtlMap dissolve_map;                  ///< map_d
  MtlMap bump_map;                      ///< map_bump, map_Bump, bump
  MtlMap normal_map;                    ///< norm, map_Kn
  MtlMap roughness_map;                 ///< map_Pr
  MtlMap metallic_map;                  ///< map_Pm
  MtlMap sheen_map;                     ///< map_Ps
  MtlMap coat_map;                      ///< map_Pc
  MtlMap coat_roughness_map;            ///< map_Pcr
  std::vector<std::string> unknown;     ///< what has no counterpart: "line 7: disp"

  /// Whether any key of physically based shading is there.
  bool physical() const;
};

/// The materials of an MTL file, in order; the last of several with one name counts. Errors name
/// the line: numbers that are none.
Result<std::vector<MtlMaterial>> parse_mtl(std::string_view text);

}  // namespace hyades::core
