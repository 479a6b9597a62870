#pragma once

#include <array>
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
#include "core/job/visibility_desc.h"

namespace hyades::core {

/// Light that a shape gives off.
struct EmitDesc {
  ColorInput color{Animated<Rgb>(Rgb(1.0F)), {}};
  enum class Unit { radiance, power } unit = Unit::radiance;
  /// Multiplied with color: how bright it looks; or what the whole shape gives off, with a plain
  /// color (a texture only shares it out).
  Animated<float> amount{1.0F};
  bool two_sided = false;  ///< open shapes: give light from the back too
  Animated<float> spread{
      180.0F};              ///< twice the angle from the normal that light leaves at, at most
  std::string light_group;  ///< empty: none
  LightLinkDesc links;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kNotNegative);
    visit.either("radiance", kNotNegative.in("W/(m² sr)"), "power", kNotNegative.in("W"), self.unit,
                 self.amount);
    visit.flag("two_sided", self.two_sided);
    visit.animated("spread", self.spread, Range{0.0, 180.0, true}.in("degrees"));
    visit.light_group("light_group", self.light_group);
    LightLinkDesc::fields(self.links, visit);
  }
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

inline const std::array<std::string, 5> kShapeNames = {"sphere", "rectangle", "disk", "box",
                                                       "cylinder"};
inline const std::array<std::string, 3> kMeshNormalsNames = {"file", "flat", "smooth"};
inline const std::array<std::string, 3> kCurveBasisNames = {"catmull-rom", "bezier", "b-spline"};

struct ObjectDesc {
  std::string name;
  SourceLocation where;
  std::string shape;                        ///< of kShapeNames, mesh, curves, instance or group
  std::string mesh;                         ///< file, or one for each frame (frame_files.h)
  std::string curves;                       ///< file of strands
  std::string basis = kCurveBasisNames[0];  ///< curves: what their points mean
  std::string part;  ///< mesh: the material of the file whose triangles are meant; empty: all
  std::string instance_of;            ///< name in Job::groups
  std::string places;                 ///< instance: file of where copies stand; empty: one, here
  std::vector<ObjectDesc> children;   ///< group written in place
  Animated<float> radius{1.0F};       ///< sphere, disk, cylinder
  Animated<Vec2> extent{Vec2(1.0F)};  ///< rectangle: along x and z
  Animated<Vec3> size{Vec3(1.0F)};    ///< box
  Animated<float> height{1.0F};       ///< cylinder, along y
  bool caps = true;                   ///< cylinder
  std::string smooth = kMeshNormalsNames[0];  ///< mesh: its normals
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
  VisibilityDesc visible;
  bool holdout = false;  ///< where the camera sees it, the picture is transparent
  std::optional<DisplacementDesc> displacement;  ///< of meshes

  /// The keys of all objects, then those of its shape.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.enter_section("objects");
    visit.name_of("material", self.material, NameKind::material);
    visit.overrides("override", self.overrides);
    visit.place(self.transform, self.at);
    visit.flag("visible_to_camera", self.visible.camera);
    VisibilityDesc::scattered_fields(self.visible, visit);
    visit.flag("visible_to_shadow", self.visible.shadow);
    visit.flag("holdout", self.holdout);
    if (self.shape == "instance") {
      visit.name_of(KeyName{"instance", "instance_of"}, self.instance_of, NameKind::group);
      visit.enter_section("objects.instance");
      visit.file("places", self.places);
    } else if (self.shape == "group") {
      visit.children("group", self.children);
    } else if (self.shape == "curves") {
      visit.file("curves", self.curves);
      visit.enter_section("objects.curves");
      visit.choice("basis", self.basis, kCurveBasisNames);
    } else if (!self.shape.empty()) {
      fields_of_shape(self, visit);
      visit.enter_section("objects.bodies");
      visit.name_of("interior", self.interior, NameKind::medium);
      visit.name_of("exterior", self.exterior, NameKind::medium);
      visit.integer("priority", self.priority, -1000, 1000);
    }
    visit.enter_section("objects." + self.shape);
  }

 private:
  template <class Self, class Visitor>
  static void fields_of_shape(Self& self, Visitor& visit) {
    if (self.shape == "mesh") visit.frame_file("mesh", self.mesh, FrameFiles::own_and_next);
    visit.enter_section("objects.shapes");
    visit.map("emit", "objects.emit", self.emit);
    visit.enter_section("objects." + self.shape);
    if (self.shape == "mesh") {
      visit.choice(KeyName{"normals", "smooth"}, self.smooth, kMeshNormalsNames);
      visit.text("part", self.part, "the name of a material in the mesh's file (usemtl)");
      visit.map("displacement", "objects.mesh.displacement", self.displacement);
    } else if (self.shape == "rectangle") {
      visit.animated(KeyName{"size", "extent"}, self.extent, kPositive.in("length"));
    } else if (self.shape == "box") {
      visit.animated("size", self.size, kPositive.in("length"));
    } else {
      visit.animated("radius", self.radius, kPositive.in("length"));
    }
    if (self.shape != "cylinder") return;
    visit.animated("height", self.height, kPositive.in("length"));
    visit.flag("caps", self.caps);
  }
};

/// Whether a shape is closed, so that something can be inside of it; of meshes it is believed.
inline bool has_inside(const ObjectDesc& object) {
  return object.shape == "mesh" || object.shape == "sphere" || object.shape == "box" ||
         (object.shape == "cylinder" && object.caps);
}

struct GroupDesc {
  std::string name;
  SourceLocation where;
  std::vector<ObjectDesc> objects;
};

}  // namespace hyades::core
