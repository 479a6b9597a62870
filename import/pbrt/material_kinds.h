#pragma once

#include <string>

#include "import/pbrt/layer_walk.h"
#include "import/pbrt/materials.h"

namespace hyades::core::pbrt {

struct MadeMaterial {
  YamlPtr node;  ///< null: it cannot be made, and the report says why
  std::string interior;
  bool is_interface = false;
};

/// Makes one material of the scene in the job language.
class MaterialKinds {
 public:
  MaterialKinds(Materials& materials, Context& context, Textures& textures, const Entity& entity,
                std::string wish, bool strands);

  MadeMaterial make(const std::string& type);

 private:
  YamlPtr coated_conductor();
  YamlPtr coated_diffuse();
  YamlPtr conductor();
  YamlPtr dielectric();
  YamlPtr diffuse();
  YamlPtr diffuse_transmission();
  YamlPtr hair();
  YamlPtr hair_on_surface();
  YamlPtr interface();
  YamlPtr measured();
  YamlPtr mix();
  YamlPtr subsurface();
  YamlPtr thin_dielectric();

  /// Roughness as the job language has it, whose square is alpha; null where the surface is smooth.
  YamlPtr roughness(const std::string& prefix);
  /// Adds it, and that facets are those of pbrt, where the surface is not smooth.
  void put_facets(YamlMap& out, const std::string& prefix);
  /// The layer that parameters tell, all but whether it scatters; `rough`: its roughness().
  CoatLayer layer(const std::string& prefix, const YamlPtr& rough);
  Rgb layer_albedo();
  /// A matt base's colour as the job language's coat wants it, below a layer of pbrt.
  YamlPtr below_coat(const YamlPtr& color, const CoatLayer& layer, const Rgb& albedo);
  float index(const char* name, float otherwise);
  /// Adds eta and k, metal or color; those of metal are divided by `around`, the index outside.
  void put_metal(YamlMap& out, const std::string& prefix, float around);
  /// Another material that this one is made of.
  std::string part(const char* name, const YamlPtr& node);
  void put_bumps(YamlMap& out);
  void note(const std::string& what);

  Materials& materials_;
  Context& context_;
  Textures& textures_;
  const Entity& entity_;
  std::string wish_;
  bool strands_;  ///< what it is for
  ParameterReader reader_;
  std::string interior_;
  bool remap_ = true;
};

}  // namespace hyades::core::pbrt
