#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/rect.h"
#include "core/cameras/camera.h"
#include "core/film/layout.h"
#include "core/geometry/world.h"
#include "core/lights/light_selector.h"
#include "core/materials/make_material.h"
#include "core/media/make_medium.h"
#include "core/scene/film_motion.h"
#include "core/scene/medium_stack.h"

namespace hyades::core {

/// What surfaces that the job gives no material are called.
inline constexpr const char* kDefaultMaterial = "default";

/// Whom a light lights.
struct LightLink {
  RayKind seen_by = RayKind::all;  ///< of scattered rays
  uint8_t receivers = 0;           ///< the list of the objects that it lights
  uint8_t blockers = 0;            ///< the list of those that cast shadows in its light
};

/// What a placement of the world looks like and gives off.
struct SceneObject {
  static constexpr uint32_t kNoLight = ~0U;

  MaterialPtr material;
  uint32_t light = kNoLight;  ///< index in Scene::lights where the surface emits
  /// Whether rays straight from the camera go through it where they come from behind (see
  /// docs/job.md, "Sides"); all others meet both sides.
  bool front_only = false;
  bool holdout = false;           ///< paths from the camera end there, and bring nothing
  ListBits in_lists = kAllLists;  ///< the lists that it is in (core/scene/light_linking.h)
  /// The body that light which crosses the surface comes into; null: none, or none that matters to
  /// light.
  const Body* body = nullptr;
  std::string name;                      ///< "tree1/trunk": the path through groups
  std::string material_name;             ///< as in the job; kDefaultMaterial where it has none
  std::array<uint32_t, kIdKinds> ids{};  ///< of name and material_name (id_of)
};

/// One frame, ready to be rendered: immutable, thread-safe, in metres.
struct Scene {
  std::shared_ptr<const World> world;
  std::vector<SceneObject> objects;  ///< by placement
  std::deque<Body> bodies;
  std::vector<LightPtr> lights;
  std::vector<std::string> light_names;   ///< one each, as in the job, for messages
  std::vector<std::string> light_groups;  ///< one each; empty: none
  std::vector<LightLink> light_links;     ///< one each
  ListBits rest_in_lists = kAllLists;     ///< the lists that are not of named objects only
  /// The lists of blockers of lights that rays find.
  ListBits blocker_lists = 0;
  /// Media whose light has a group, and its name.
  std::vector<std::pair<const Medium*, std::string>> medium_groups;
  std::vector<uint32_t>
      infinite_lights;  ///< indices in `lights` that rays find where they leave the world
  std::unique_ptr<LightSelector> selector;
  std::shared_ptr<const Camera> camera;
  std::unique_ptr<const FilmMotion> motion;  ///< null: the job asks for no layer of motion
  MediumPtr atmosphere;                      ///< what is outside of all bodies; null: nothing
  bool has_media = false;                    ///< whether there is a medium anywhere
  /// Whether light crosses some surface unscattered and it matters which: that of a body, null or
  /// hidden in another body, or one that is not all there.
  bool has_shells = false;
  MediumStack around_camera;        ///< what the camera stands in (bodies_around_lens)
  bool environment_visible = true;  ///< whether camera rays see the infinite lights
  bool tells_rays_apart = false;    ///< whether kinds of scattered rays see different things
  /// Whether shadow rays see other things than scattered ones do, or not of all lights the same.
  bool shadows_differ = false;
  bool hides_bodies = false;  ///< whether some body is not there for all rays but the camera's
  Vec2i resolution{0, 0};     ///< full frame, pixels
  PixelRect window;           ///< what the job renders of it: splats elsewhere are lost

  /// What is probably not meant, in the job's words, one line each.
  std::vector<std::string> warnings;

  /// The lists that the place in the bodies `around` is in, where it is on no surface.
  ListBits lists_within(const MediumStack& around) const {
    return around.body() != nullptr ? objects[around.body()->object].in_lists : rest_in_lists;
  }
  /// Whether light `index` lights what is in `lists`.
  bool links(uint32_t index, ListBits lists) const {
    return is_in(lists, light_links[index].receivers);
  }

  size_t triangles = 0;       ///< as placed: instances count each time
  size_t texture_memory = 0;  ///< bytes of image pixels
};

}  // namespace hyades::core
