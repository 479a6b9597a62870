#pragma once

#include <map>
#include <string>

#include "core/base/result.h"
#include "core/job/job.h"
#include "core/materials/make_material.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// The textures and materials of a job at one moment, made on first use and shared afterwards.
/// `units`: metres per unit of length of the job.
class Appearance {
 public:
  Appearance(const Job& job, const JobTime& time, SceneCache& cache)
      : job_(job), time_(time), cache_(cache) {}

  /// The texture called `name`.
  Result<TexturePtr> texture(const std::string& name);

  /// The material called `name`; the grey default for "".
  Result<MaterialPtr> material(const std::string& name);

 private:
  Result<TexturePtr> make_texture(const TextureDesc& desc);
  Result<MaterialPtr> make_material(const MaterialDesc& desc);
  Result<ColorParam> color(const ColorInput& input);
  Result<ScalarParam> scalar(const ScalarInput& input);
  Result<TexturePtr> color_texture(const ColorInput& input);

  const Job& job_;
  JobTime time_;
  SceneCache& cache_;
  std::map<std::string, TexturePtr> textures_;
  std::map<std::string, MaterialPtr> materials_;
  int depth_ =
      0;  ///< of references in progress: the parser refuses cycles, this stops what slips through
};

}  // namespace hyades::core
