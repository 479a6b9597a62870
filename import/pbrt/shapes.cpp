#include "import/pbrt/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "import/pbrt/instances.h"
#include "import/pbrt/lights.h"
#include "import/pbrt/made_meshes.h"
#include "import/pbrt/mesh_files.h"
#include "import/pbrt/meshes.h"
#include "import/pbrt/motion.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {
namespace {

constexpr size_t kBytesPerTriangle = 16;  ///< of a PLY file, about

/// Our spheres, disks and cylinders stand around y, pbrt's around z.
Mat4d z_for_y() { return rotation(90.0, Vec3d(1.0, 0.0, 0.0)); }

/// "geometry/dragon.ply.gz" -> "dragon"
std::string stem(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  return file.substr(0, file.find('.'));
}

/// What a shape is made of that is not said by Context.
void skip_known(ParameterReader& reader) {
  for (const char* name : {"P", "N", "uv", "st", "indices", "alpha"}) reader.find(name);
}

}  // namespace

Shapes::Shapes(Context& context, Materials& materials, Textures& textures, Media& media)
    : context_(context), materials_(materials), textures_(textures), media_(media) {}

bool Shapes::can_be_made(const ShapeEntity& shape) {
  // Very many may share a long list, and are looked through only as long as it matters.
  const bool refused = context_.report.errors.size() >= Report::kMostErrors;
  if (refused || !context_.may_make(0, shape.place)) return false;
  const auto elements = check_mesh(shape, context_.report);
  if (elements) return context_.may_make(*elements, shape.place);
  context_.report.errors.push_back(elements.error().message);
  return false;
}

YamlPtr Shapes::geometry(const ShapeEntity& shape, const std::string& file, bool sided,
                         Mat4d& before, std::string& wish) {
  ParameterReader reader = read(context_, shape);
  skip_known(reader);
  YamlMap out;
  const bool strand = is_strand(shape);
  const std::string made = context_.request.made + "meshes/" + file + (strand ? ".hair" : ".ply");
  const auto positive = [&](float value, const char* what) {
    if (value > 0.0F) return true;
    context_.report.error(shape.place, std::string(what) + " is not above 0");
    return false;
  };
  if (strand) {
    if (!can_be_made(shape)) return nullptr;
    out.put("curves", yaml_text(made)).put("basis", yaml_word("bezier"));
  } else if (is_made_mesh(shape)) {
    if (!can_be_made(shape)) return nullptr;
    if (reader.find("faceIndices") != nullptr) {
      context_.report.note(shape.place, "faceIndices are left out");
    }
    if (reader.find("S") != nullptr) context_.report.note(shape.place, "tangents are left out");
    if (reader.find("emissionfilename") != nullptr) {
      context_.report.note(shape.place, "emissionfilename is left out");
    }
    out.put("mesh", yaml_text(made));
  } else if (shape.type == "plymesh") {
    const std::string reference = reader.text("filename");
    const std::string beside = context_.beside(reference, shape.place);
    if (beside.empty()) return nullptr;
    wish = stem(reference);
    const bool turned = shape.reversed && sided;
    const auto whole = context_.loaded.files.find(reference);
    if (turned && whole != context_.loaded.files.end() &&
        !context_.may_make(whole->second.size() / kBytesPerTriangle, shape.place)) {
      return nullptr;
    }
    out.put("mesh", yaml_text(turned ? made : beside));
    if (const Parameter* p = reader.find("texture", "displacement")) {
      const Textures::Height height = textures_.height(p->texts[0], p->place);
      const double stretch = std::cbrt(std::abs(linear_determinant(shape.to_world.at[0])));
      const float edge = reader.number("edgelength", 1.0F) / static_cast<float>(stretch);
      if (height.texture != nullptr && positive(edge, "edgelength")) {
        out.put("displacement", YamlMap{{"texture", height.texture},
                                        {"height", yaml_number(height.factor)},
                                        {"max_edge", yaml_number(edge)}});
      }
    }
    reader.number("edgelength", 1.0F);
  } else if (shape.type == "sphere") {
    const float radius = reader.number("radius", 1.0F);
    for (const char* name : {"zmin", "zmax", "phimax"}) reader.number(name, 0.0F);
    if (!positive(radius, "the radius")) return nullptr;
    before = z_for_y();
    out.put("shape", yaml_word("sphere")).put("radius", yaml_number(radius));
  } else if (shape.type == "disk") {
    const float radius = reader.number("radius", 1.0F);
    const float height = reader.number("height", 0.0F);
    for (const char* name : {"innerradius", "phimax"}) reader.number(name, 0.0F);
    if (!positive(radius, "the radius")) return nullptr;
    const Mat4d turned = shape.reversed ? rotation(-90.0, Vec3d(1.0, 0.0, 0.0)) : z_for_y();
    before = translation({0.0, 0.0, height}) * turned;
    out.put("shape", yaml_word("disk")).put("radius", yaml_number(radius));
  } else if (shape.type == "cylinder") {
    const float radius = reader.number("radius", 1.0F);
    const float low = reader.number("zmin", -1.0F);
    const float high = reader.number("zmax", 1.0F);
    reader.number("phimax", 360.0F);
    if (!positive(radius, "the radius") || !positive(high - low, "zmax - zmin")) return nullptr;
    before = translation({0.0, 0.0, low}) * z_for_y();
    out.put("shape", yaml_word("cylinder"))
        .put("radius", yaml_number(radius))
        .put("height", yaml_number(high - low))
        .put("caps", yaml_flag(false));
  } else {
    static const std::vector<std::string> names = {"bilinearmesh", "curve",       "cylinder",
                                                   "disk",         "loopsubdiv",  "plymesh",
                                                   "sphere",       "trianglemesh"};
    context_.report.error(
        shape.place, "there is no shape '" + shape.type + "'" + did_you_mean(shape.type, names));
    return nullptr;
  }
  if (!strand && !is_made_mesh(shape)) reader.note_unused();
  return out.node();
}

YamlPtr Shapes::objects(const std::vector<ShapeEntity>& shapes, const std::string& made,
                        bool in_group) {
  Names names("object", in_group ? std::string() : context_.request.prefix);
  YamlMap out;
  size_t run = 1;
  for (size_t i = 0; i < shapes.size(); i += run) {
    const ShapeEntity& shape = shapes[i];
    run = mesh_run(shapes, i);
    const WrittenMaterial material = materials_.of(shape);
    if (material.name.empty()) continue;
    const bool shines = shape.area_light >= 0 && !material.is_interface && !in_group;
    if (shape.area_light >= 0 && !shines) {
      context_.report.note(shape.place, in_group ? "objects that are placed many times do not shine"
                                                 : "a shape of material interface does not shine");
    }
    std::string wish = shape.material_name.empty() ? shape.type : shape.material_name;
    Mat4d before(1.0);
    const std::string file = made + mesh_run_name(i, run);
    if (run > 1) {
      for (size_t k = i + 1; k < i + run; ++k) can_be_made(shapes[k]);
    }
    const YamlPtr geometry = this->geometry(shape, file, shines || material.sided, before, wish);
    if (geometry == nullptr) continue;
    YamlMap object;
    for (const YamlEntry& entry : geometry->map) object.put(entry.key, entry.value);

    ParameterReader reader = read(context_, shape);
    std::string used = material.name;
    const YamlPtr alpha = textures_.number_if(reader, "alpha");
    const auto number = plain_number(alpha);
    if (alpha != nullptr && number.value_or(0.0F) < 1.0F) {
      if (number && *number == 0.0F && shines) {
        // Seen through, but shining all the same.
        context_.report.note(shape.place,
                             "an area light of alpha 0 is only hidden from the camera");
        object.put("visible_to_camera", yaml_flag(false));
      } else {
        used = materials_.cut_out(material, number ? yaml_number(std::max(*number, 0.0F)) : alpha);
      }
    }
    object.put("material", yaml_text(used));
    if (shape.inside != shape.outside || !material.interior.empty()) {
      std::string inside = media_.named(shape.inside, shape.to_world.at[0] * before, shape.place);
      if (!material.interior.empty()) inside = material.interior;
      if (!inside.empty()) object.put("interior", yaml_text(inside));
      if (inside.empty() && !shape.outside.empty() && material.sided &&
          shape.outside != context_.scene.camera_medium) {
        context_.report.note(shape.place,
                             "the medium '" + shape.outside +
                                 "' is only outside of this surface: a closed body of it has to be "
                                 "around; a surface that two bodies share cannot be said");
      }
    }
    if (shines) {
      const Entity& light = context_.scene.area_lights[static_cast<size_t>(shape.area_light)];
      if (const YamlPtr emit = emission_node(context_, light)) object.put("emit", emit);
    }
    if (const YamlPtr steps =
            motion_node(context_, shape.to_world, before, shape.place, in_group)) {
      object.put("transform", steps);
    }
    out.put(names.add(wish), object);
  }
  return out.empty() ? nullptr : out.node();
}

void add_objects(Context& context, Textures& textures, YamlMap& out) {
  Materials materials(context, textures);
  Media media(context);
  if (!context.scene.camera_medium.empty()) {
    const std::string around =
        media.named(context.scene.camera_medium, Mat4d(1.0), context.scene.camera.place);
    if (!around.empty()) out.put("atmosphere", yaml_text(around));
  }
  Shapes shapes(context, materials, textures, media);
  YamlMap objects;
  if (const YamlPtr own = shapes.objects(context.scene.shapes, "shape-", false)) {
    for (const YamlEntry& entry : own->map) objects.put(entry.key, entry.value);
  }
  YamlMap groups;
  add_instances(context, shapes, groups, objects);
  if (!groups.empty()) out.put("groups", groups);
  if (!objects.empty()) out.put("objects", objects);
}

}  // namespace hyades::core::pbrt
