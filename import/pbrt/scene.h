#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/point_instancer.h"
#include "import/pbrt/parameters.h"

namespace hyades::core::pbrt {

using Mat4d = glm::dmat4;

/// A transform at the start and at the end of its motion; columns as glm has them.
struct Motion {
  std::array<Mat4d, 2> at{Mat4d(1.0), Mat4d(1.0)};
  bool moves() const { return at[0] != at[1]; }
};

/// Something that a directive makes: "sphere", "diffuse", "point", ...
struct Entity {
  std::string type;
  Parameters parameters;
  Place place;
  const RgbSpace* space = srgb_space();
};

struct PlacedEntity : Entity {
  Motion to_world;
};

struct NamedEntity : PlacedEntity {
  std::string name;
};

struct LightEntity : PlacedEntity {
  std::string outside;  ///< the medium around it
};

struct ShapeEntity : PlacedEntity {
  bool reversed = false;      ///< ReverseOrientation
  size_t material = 0;        ///< index, where material_name is empty
  std::string material_name;  ///< of a named material
  int area_light = -1;        ///< index
  std::string inside;         ///< medium
  std::string outside;
};

/// ObjectBegin ... ObjectEnd.
struct ObjectDefinition {
  std::string name;
  Place place;
  std::vector<ShapeEntity> shapes;
  size_t still = 0;  ///< how many of its instances do not move
  /// Where they stand, but for the first kFewestCopies - 1, which are among ParsedScene::instances.
  std::vector<PlaceMatrix> copies;
};

struct ObjectInstance {
  size_t object = 0;  ///< index
  Place place;
  Motion to_world;
};

/// A scene as its files say it, defaults not yet filled in.
struct ParsedScene {
  Entity film, filter, sampler, integrator;
  PlacedEntity camera;  ///< to_world: from the camera's space to the world's
  std::string camera_medium;
  double start_time = 0.0;  ///< of Motion's two transforms (TransformTimes)
  double end_time = 1.0;
  std::vector<Entity> materials;  ///< the first is the default one
  std::vector<NamedEntity> named_materials;
  std::vector<NamedEntity> float_textures;
  std::vector<NamedEntity> spectrum_textures;
  std::vector<NamedEntity> media;
  std::vector<LightEntity> lights;
  std::vector<Entity> area_lights;
  std::vector<ShapeEntity> shapes;
  std::vector<ObjectDefinition> objects;
  std::vector<ObjectInstance> instances;
  std::vector<std::string> notes;  ///< of reading
  uint64_t bytes = 0;              ///< of its files, each counted once
};

}  // namespace hyades::core::pbrt
