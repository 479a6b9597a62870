#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/job/animated.h"
#include "core/job/fields.h"
#include "core/job/inputs.h"
#include "core/job/source.h"
#include "core/job/transform_desc.h"

namespace hyades::core {

/// Light that a shape gives off.
struct EmitDesc {
  ColorInput color{Animated<Rgb>(Rgb(1.0F)), {}};
  enum class Unit { radiance, power } unit = Unit::radiance;
  /// W/(m^2 sr), multiplied with color; or W over the whole shape, multiplied with a plain color (a
  /// texture only shares it out).
  Animated<float> amount{1.0F};
  bool two_sided = false;   ///< open shapes: give light from the back too
  std::string light_group;  ///< empty: none
};

/// Most triangles that a displacement's budget may allow.
inline constexpr int64_t kMostDisplacedTriangles = 200'000'000;

/// How a texture moves the surface of a mesh. Lengths are in the mesh's own space.
struct DisplacementDesc {
  std::string texture;             ///< name in Job::textures
  Animated<float> height{1.0F};    ///< how far its white is from its black, outwards
  Animated<float> midlevel{0.0F};  ///< the texture's number where the surface stays, 0..1
  float max_edge = 0.0F;           ///< longest edge of its triangles; 0: 1/256 of the longest side
  uint32_t budget = 4'000'000;     ///< most triangles

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.texture("texture", self.texture);
    visit.animated("height", self.height, kAnyNumber.in("length"));
    visit.animated("midlevel", self.midlevel, kUnitInterval);
    visit.number("max_edge", self.max_edge, kPositive.in("length"));
    visit.integer("budget", self.budget, 1, kMostDisplacedTriangles);
  }
};

struct ObjectDesc {
  std::string name;
  SourceLocation where;
  std::string shape;  ///< mesh | sphere | rectangle | disk | box | cylinder | instance | group
  std::string mesh;   ///< file, or one for each frame (mesh_files.h)
  std::string part;   ///< mesh: the material of the file whose triangles are meant; empty: all
  std::string instance_of;            ///< name in Job::groups
  std::string places;                 ///< instance: file of where copies stand; empty: one, here
  std::vector<ObjectDesc> children;   ///< group written in place
  Animated<float> radius{1.0F};       ///< sphere, disk, cylinder
  Animated<Vec2> extent{Vec2(1.0F)};  ///< rectangle: along x and z
  Animated<Vec3> size{Vec3(1.0F)};    ///< box
  Animated<float> height{1.0F};       ///< cylinder, along y
  bool caps = true;                   ///< cylinder
  std::string smooth = "file";        ///< mesh normals: file | flat | smooth
  std::string material;  ///< empty: inherited from the group, else of the medium's index
                         ///< of refraction, else grey lambert
  std::string interior;  ///< name in Job::media of what fills it; empty: nothing
  std::string exterior;  ///< name in Job::media of what is around it; empty: not said
  int32_t priority = 0;  ///< where bodies overlap, the highest says what is there
  TransformList transform;
  Animated<Vec3> at{Vec3(0.0F)};  ///< translation after `transform`
  /// Materials that objects in it have, and those that they get instead: names.
  std::vector<std::pair<std::string, std::string>> overrides;
  std::optional<EmitDesc> emit;
  bool visible_to_camera = true;
  /// Of meshes.
  std::optional<DisplacementDesc> displacement;
};

struct GroupDesc {
  std::string name;
  SourceLocation where;
  std::vector<ObjectDesc> objects;
};

}  // namespace hyades::core
