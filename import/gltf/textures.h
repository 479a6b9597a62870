#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/job/yaml_build.h"
#include "import/gltf/model.h"
#include "import/names.h"
#include "import/scene_source.h"

namespace hyades::core {

/// The pictures and textures of a file as a job's textures, each as it is first asked for.
class GltfTextures {
 public:
  GltfTextures(const GltfModel& model, const SceneRequest& request,
               const std::vector<std::string>& image_files, std::vector<std::string>& notes);

  /// How the numbers of a picture are meant.
  enum class Meaning { color, data };

  /// The name of the texture that textureInfo `info` (its `index`, `texCoord` and
  /// KHR_texture_transform) stands for, `channel` of it ("" for its colour). Empty where there is
  /// none, or none that can be shown (there is a note then).
  std::string name(const JsonValue& info, Meaning meaning, const std::string& channel);

  /// The job's section.
  const YamlMap& section() const { return section_; }
  /// What was wrong with them; empty: nothing.
  const JsonTrouble& trouble() const { return trouble_; }

 private:
  void describe_sampler(int sampler, YamlMap& out);
  YamlPtr transform_of(const JsonValue& info);  ///< steps, or null
  std::string file_of(int image) const;

  const GltfModel& model_;
  const SceneRequest& request_;
  const std::vector<std::string>& image_files_;
  std::vector<std::string>& notes_;
  JsonTrouble trouble_;
  std::vector<JsonValue> textures_;
  std::vector<JsonValue> samplers_;
  Names names_;
  std::map<std::string, std::string> made_;  ///< name by all that decides a texture
  YamlMap section_;
};

/// The name of an image's file among those that are made, "images/wood.png"; empty for images that
/// lie beside the scene's file.
std::vector<std::string> image_file_names(const GltfModel& model);

}  // namespace hyades::core
