#pragma once

#include <memory>
#include <string>

#include "core/render/render_frame.h"
#include "core/scene/scene_cache.h"
#include "import/scene_source.h"

namespace hyades::test {

/// How a scene of another tool is rendered in a test.
struct SceneView {
  std::string yaml;  ///< sections of a job that replace those of the scene: film, camera, ...
  std::string animation = {};  ///< the one that is meant
  bool loop = false;           ///< whether it begins again
  float fps = 24.0F;
  int32_t frame = 1;
  int samples = 16;
  /// Texts of the job that are replaced by others; each must be there.
  std::vector<std::pair<std::string, std::string>> edits = {};
};

/// A picture of an imported scene.
struct ScenePicture {
  core::Image image;  ///< normalised film: R, G, B, alpha, ...
  std::vector<std::string> notes;
  std::string job;  ///< as text

  core::Rgb at(int x, int y) const;
  /// Mean over x0 <= x < x1, y0 <= y < y1; row 0 is the top.
  core::Rgb mean(int x0, int y0, int x1, int y1) const;
};

/// What an orthographic camera that looks along -z shows.
struct Window {
  float x = 0.0F;  ///< of the middle
  float y = 0.0F;
  float height = 1.0F;
  int pixels_across = 64;
  int pixels_high = 64;
  float from = 50.0F;  ///< z of the camera

  std::string yaml() const;  ///< film and camera
  /// Mean over a square of side 2 half around a place.
  core::Rgb mean(const ScenePicture& picture, float at_x, float at_y, float half) const;
  /// The variance of the luminance there, over its squared mean.
  double contrast(const ScenePicture& picture, float at_x, float at_y, float half) const;
};

/// Renders `source`; files beside it are relative to `folder`. Throws where it cannot be. Where the
/// environment names a folder in HYADES_TEST_PICTURES, the picture is left there as `name`.png.
ScenePicture render_scene(const core::SceneSource& source, const SceneView& view,
                          const std::string& folder, const std::string& name);

}  // namespace hyades::test
