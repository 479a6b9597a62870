#pragma once

#include <memory>
#include <string>

#include "core/base/assets.h"
#include "core/job/job.h"
#include "core/render/render_frame.h"
#include "core/scene/scene_cache.h"
#include "tests/support/means.h"

namespace hyades::test {

/// A job written in a test, its scene at one frame, ready to render. Fails the test (and throws)
/// where the job has mistakes. References to files are relative to `folder`.
class YamlScene {
 public:
  explicit YamlScene(const std::string& yaml, int32_t frame = 1, const core::LayerSet& layers = {},
                     const std::string& folder = ".");

  /// All of the job's window.
  core::RenderedFrame render(const core::RenderFrameOptions& options = {.threads = 2}) const;

  /// All of the job's window by another integrator than the job's.
  core::RenderedFrame render_by(const core::IntegratorDesc& integrator) const;

  /// The whole frame whatever the job's crop is.
  const core::Job& job() const { return job_; }
  const core::FrameRenderer& renderer() const { return *renderer_; }

 private:
  std::unique_ptr<core::AssetResolver> assets_;
  core::Job job_;
  std::unique_ptr<core::SceneCache> cache_;
  std::unique_ptr<core::FrameRenderer> renderer_;
  int32_t frame_;
};

/// Mean and standard error of the mean of each channel of a film's beauty over all its pixels, from
/// the pixels' own variances (independent noise).
struct PictureMean {
  core::Vec3d mean{0.0};
  core::Vec3d sigma{0.0};
};
PictureMean picture_mean(const core::Film& film);

/// Whether each channel's mean over the rendered picture is `expected`; fails too where the picture
/// could not have told.
void expect_picture_mean(const YamlScene& scene, const core::Vec3d& expected,
                         const Promise& promise);

/// As expect_picture_mean, by `path` and by `bdpt`, whatever the job's integrator is.
void expect_mean_by_path_and_bdpt(const YamlScene& scene, const core::Vec3d& expected,
                                  const Promise& promise);

/// The folder of real-world inputs, beside the repository or where HYADES_SHARED names it; empty
/// where it is absent.
std::string shared_folder();

/// A job's text with that folder in place of ../../../shared.
std::string with_shared_folder(std::string text);

}  // namespace hyades::test
