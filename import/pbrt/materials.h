#pragma once

#include <map>
#include <string>
#include <unordered_set>
#include <utility>

#include "import/pbrt/layer_walk.h"
#include "import/pbrt/textures.h"

namespace hyades::core::pbrt {

/// A material of the scene in the job language.
struct WrittenMaterial {
  std::string name;           ///< empty: it could not be made
  std::string interior;       ///< the medium that bodies of it are filled with, or empty
  bool is_interface = false;  ///< nothing but a border of media
  bool sided = false;         ///< it matters which side is the outer one
};

/// Puts the materials that something uses into Context::materials, each once.
class Materials {
 public:
  Materials(Context& context, Textures& textures);

  /// That of a shape.
  const WrittenMaterial& of(const ShapeEntity& shape);

  /// The name of `material` with an opacity; `opacity` is a number or the name of a texture.
  std::string cut_out(const WrittenMaterial& material, const YamlPtr& opacity);

 private:
  /// `strands`: it is for those.
  const WrittenMaterial& written(const Entity& entity, const std::string& type,
                                 const std::string& wish, bool strands);

  Context& context_;
  Textures& textures_;
  std::map<std::string, const NamedEntity*> named_;
  std::map<std::pair<const Entity*, bool>, WrittenMaterial> written_;
  std::unordered_set<const Entity*> making_;     ///< those that are made of each other
  std::map<std::string, std::string> same_;      ///< text -> name, of those without one
  std::map<std::string, std::string> cut_outs_;  ///< material and opacity -> name
  LayerAnswers layers_;
  friend class MaterialKinds;
};

}  // namespace hyades::core::pbrt
