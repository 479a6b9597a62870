#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/rect.h"
#include "core/cameras/camera.h"
#include "core/geometry/world.h"
#include "core/lights/light_selector.h"
#include "core/materials/make_material.h"
#include "core/media/make_medium.h"
#include "core/scene/medium_stack.h"

namespace hyades::core {

/// What a placement of the world looks like and gives off.
struct SceneObject {
  static constexpr uint32_t kNoLight = ~0U;
  static constexpr uint32_t kNoBody = ~0U;

  MaterialPtr material;
  uint32_t light = kNoLight;  ///< index in Scene::lights where the surface emits
  /// The body whose surface this is, where light that crosses it comes into another medium; one
  /// number for all surfaces of a body (a cylinder and its caps). Only in scenes with media.
  uint32_t body = kNoBody;
  MediumPtr interior;  ///< of the body; null: nothing
  std::string name;    ///< "tree1/trunk": the path through groups, for messages
};

/// One frame, ready to be rendered: immutable, thread-safe, in metres.
struct Scene {
  std::shared_ptr<const World> world;
  std::vector<SceneObject> objects;  ///< by placement
  std::vector<LightPtr> lights;
  std::vector<std::string> light_names;  ///< one each, as in the job, for messages
  std::vector<uint32_t>
      infinite_lights;  ///< indices in `lights` that rays find where they leave the world
  std::unique_ptr<LightSelector> selector;
  std::unique_ptr<Camera> camera;
  MediumPtr atmosphere;       ///< what is outside of all bodies; null: nothing
  bool has_media = false;     ///< whether there is a medium anywhere
  bool has_shells = false;    ///< whether light crosses the surface of a body unscattered (null)
  MediumStack around_camera;  ///< what the camera stands in
  bool environment_visible = true;  ///< whether camera rays see the infinite lights
  Vec2i resolution{0, 0};           ///< full frame, pixels
  PixelRect window;                 ///< what the job renders of it: splats elsewhere are lost

  size_t triangles = 0;       ///< as placed: instances count each time
  size_t texture_memory = 0;  ///< bytes of image pixels
};

}  // namespace hyades::core
