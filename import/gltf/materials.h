#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "import/gltf/textures.h"
#include "import/names.h"

namespace hyades::core {

/// What an object of a material has to say itself.
struct GltfMaterial {
  std::string name;      ///< in the job
  std::string interior;  ///< the medium that fills it; empty: none
  YamlPtr emit;          ///< the light of a surface that shines on both sides, or null
  bool shines = false;   ///< whether it gives off light at all
};

/// The materials of a file as a job's materials and media, each as it is first asked for.
class GltfMaterials {
 public:
  GltfMaterials(const GltfModel& model, const SceneRequest& request, GltfTextures& textures,
                std::vector<std::string>& notes);

  /// Material `index`, or the default one for -1; `colored`: times the colours of the vertices.
  const GltfMaterial& get(int index, bool colored);

  const YamlMap& materials() const { return materials_; }
  const YamlMap& media() const { return media_; }
  /// What was wrong with them; empty: nothing.
  const JsonTrouble& trouble() const { return trouble_; }

 private:
  void write(const JsonValue& value, bool colored, GltfMaterial& out);

  const GltfModel& model_;
  GltfTextures& textures_;
  std::vector<std::string>& notes_;
  JsonTrouble trouble_;
  std::vector<JsonValue> values_;
  Names names_;
  std::map<std::pair<int, bool>, GltfMaterial> made_;  ///< by index and whether it is coloured
  YamlMap materials_;
  YamlMap media_;
};

}  // namespace hyades::core
