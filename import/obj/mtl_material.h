#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/job/yaml_build.h"
#include "import/obj/mtl_file.h"

namespace hyades::core {

/// What a material of an MTL file is in a job.
struct MtlLook {
  YamlMap material;                ///< an entry of `materials`
  YamlMap emit;                    ///< of objects that have it; empty: they do not shine
  std::vector<std::string> notes;  ///< what is left out
};

/// The mesh that has a material.
struct MtlMesh {
  float diagonal = 1.0F;  ///< its size [length], for the height of bumps, which files do not say
  bool colored = false;   ///< its vertices have colours
};

/// A picture's reference in the job, of a map's file.
using PictureOf = std::function<std::string(const std::string& file)>;

/// Classic materials: matt (`lambert`) without highlights or with those of Phong's exponent, whose
/// roughness is that of Walter et al. 2007 (alpha^2 = 2 / (Ns + 2)), Ks as the strength of the
/// reflection as Blender writes it (0.5 is glass or varnish); glass where `illum` is 4, 6, 7 or 9,
/// or where d is below 1 and Ni above 1; a mirror or metal where nothing is diffuse. Physically
/// based ones: `principled`. d and map_d are otherwise the opacity. Where neither Kd nor map_Kd is
/// said, the vertices' own colours count, if they have some, else clay.
MtlLook look_of(const MtlMaterial& material, const MtlMesh& mesh, const PictureOf& picture);

}  // namespace hyades::core
