#include "core/geometry/ray_scene.h"

#include "core/geometry/embree.h"
#include "core/geometry/tree_scene.h"

namespace hyades::core {

std::unique_ptr<SceneBuilder> make_scene_builder(RenderClass which) {
  if (which == RenderClass::native) return std::make_unique<EmbreeBuilder>();
  return std::make_unique<TreeBuilder>();
}

}  // namespace hyades::core
