#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/cameras/camera.h"
#include "core/job/job.h"
#include "core/materials/make_material.h"
#include "core/media/make_medium.h"
#include "core/scene/scene_cache.h"
#include "core/scene/volume_makers.h"

namespace hyades::core {

/// The camera of a scene as its textures see it. Textures are made first, for a camera may focus on
/// an object; until there is a camera, surfaces are seen from nowhere: places are points.
class CameraView final : public PixelView {
 public:
  /// Once, before the scene is rendered.
  void set(std::shared_ptr<const Camera> camera) { camera_ = std::move(camera); }

  PixelCone pixel_at(const Vec3& point, float time) const override {
    return camera_ ? camera_->pixel_at(point, time) : PixelCone{};
  }

 private:
  std::shared_ptr<const Camera> camera_;
};

/// The textures, materials and media of a job at one moment, made on first use and shared
/// afterwards. What the kinds are made of stands in make_texture.h and make_material.h, which ask
/// here for what they refer to.
class Appearance {
 public:
  Appearance(const Job& job, const JobTime& time, SceneCache& cache)
      : job_(job), time_(time), cache_(cache) {}

  /// The texture called `name`.
  Result<TexturePtr> texture(const std::string& name);

  /// The material called `name`; the grey default for "".
  Result<MaterialPtr> material(const std::string& name);

  /// What an object of that material is seen as. Without one, a body whose medium has an index of
  /// refraction has a smooth surface of it.
  Result<MaterialPtr> surface(const std::string& material, const std::string& interior);

  /// The medium called `name`, the same everywhere; null for "".
  Result<MediumPtr> medium(const std::string& name);

  /// The medium called `name` as it fills `body`, in which it may vary; null for "".
  Result<MediumPtr> medium_in(const std::string& name, const Placement& body);

  /// The groups of the light that media made so far give off, of those that have one.
  const std::vector<std::pair<const Medium*, std::string>>& medium_groups() const {
    return medium_groups_;
  }

  /// Whether bodies of material `name` are filled with what its `subsurface` says, and with what.
  bool has_subsurface(const std::string& name) const;
  MediumPtr subsurface(const std::string& name);

  // A parameter at this moment: its value, or the texture that it names.
  Result<ColorParam> color(const ColorInput& input);
  Result<ScalarParam> scalar(const ScalarInput& input);
  /// A texture in any case: one of constant colour where the parameter is a value.
  Result<TexturePtr> color_texture(const ColorInput& input);

  const Job& job() const { return job_; }
  const JobTime& time() const { return time_; }
  /// Metres per unit of length of the job.
  float units() const { return job_.units; }
  SceneCache& cache() { return cache_; }
  /// How textures see the scene; whose camera it is is said later.
  const std::shared_ptr<CameraView>& view() const { return view_; }

 private:
  /// Keeps the group of `medium`, which is made of `desc`.
  MediumPtr grouped(MediumPtr medium, const MediumDesc& desc);

  const Job& job_;
  JobTime time_;
  SceneCache& cache_;
  std::shared_ptr<CameraView> view_ = std::make_shared<CameraView>();
  std::map<std::string, TexturePtr> textures_;
  std::map<std::string, MaterialPtr> materials_;
  std::map<std::string, MediumPtr> media_;
  std::map<std::string, MediumPtr> subsurfaces_;  ///< by material
  std::map<std::pair<std::string, std::array<float, 6>>, PlacedVolume>
      volumes_;  ///< by medium and bounds of the body
  std::vector<std::pair<const Medium*, std::string>> medium_groups_;
  int depth_ =
      0;  ///< of references in progress: the parser refuses cycles, this stops what slips through
};

}  // namespace hyades::core
