#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/cameras/camera.h"
#include "core/geometry/world.h"
#include "core/lights/light_selector.h"
#include "core/materials/make_material.h"

namespace hyades::core {

/// What a placement of the world looks like and gives off.
struct SceneObject {
  static constexpr uint32_t kNoLight = ~0U;

  MaterialPtr material;
  uint32_t light = kNoLight;  ///< index in Scene::lights where the surface emits
  std::string name;           ///< "tree1/trunk": the path through groups, for messages
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
  bool environment_visible = true;  ///< whether camera rays see the infinite lights
  Vec2i resolution{0, 0};           ///< full frame, pixels

  size_t triangles = 0;       ///< as placed: instances count each time
  size_t texture_memory = 0;  ///< bytes of image pixels
};

}  // namespace hyades::core
