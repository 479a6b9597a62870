#pragma once

#include <memory>
#include <utility>

#include "core/cameras/camera.h"

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

}  // namespace hyades::core
