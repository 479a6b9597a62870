#include "import/pbrt/instances.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"
#include "core/geometry/read_places.h"
#include "import/mass_copies.h"
#include "import/names.h"
#include "import/pbrt/grid_media.h"
#include "import/pbrt/motion.h"

namespace hyades::core::pbrt {
namespace {

/// Objects of a job have some twenty values each.
constexpr size_t kMostSingle = kMaxYamlNodes / 8;

/// The instances of an object that stand still, as they stand in the job.
struct Stills {
  std::vector<PlaceMatrix> in_file;
  std::vector<PlaceMatrix> single;  ///< what a file cannot tell
};

Stills stills_of(const Context& context, size_t index) {
  Stills out;
  const ObjectDefinition& object = context.scene.objects[index];
  out.in_file.reserve(object.still);
  const auto add = [&](const Mat4& matrix) {
    (can_be_copied(matrix) ? out.in_file : out.single).emplace_back(matrix);
  };
  for (const ObjectInstance& instance : context.scene.instances) {
    if (instance.object != index || instance.to_world.moves()) continue;
    add(Mat4(context.to_job * instance.to_world.at[0]));
  }
  for (const PlaceMatrix& place : object.copies) {
    add(Mat4(context.to_job * Mat4d(place_matrix(place))));
  }
  return out;
}

/// Whether an object is filled with a medium that is not the same everywhere, which copies by a
/// file cannot be.
bool varies(Context& context, const ObjectDefinition& object) {
  const auto grid = [&](const std::string& name) {
    return std::any_of(
        context.scene.media.begin(), context.scene.media.end(), [&](const NamedEntity& medium) {
          return medium.name == name && is_grid_medium(read(context, medium).text("type"));
        });
  };
  return std::any_of(object.shapes.begin(), object.shapes.end(), [&](const ShapeEntity& shape) {
    return shape.inside != shape.outside && !shape.inside.empty() && grid(shape.inside);
  });
}

class Writer {
 public:
  Writer(Context& context, Shapes& shapes, YamlMap& groups, YamlMap& objects)
      : context_(context),
        shapes_(shapes),
        groups_(groups),
        objects_(objects),
        group_names_("group", context.request.prefix),
        names_("instance", context.request.prefix),
        groups_of_(context.scene.objects.size()),
        by_file_(context.scene.objects.size()) {}

  void write() {
    for (const ObjectInstance& instance : context_.scene.instances) add_group(instance.object);
    for (const ObjectInstance& instance : context_.scene.instances) {
      const std::string& group = groups_of_[instance.object];
      if (group.empty() || (by_file_[instance.object] && !instance.to_world.moves())) continue;
      put(instance.object,
          motion_node(context_, instance.to_world, Mat4d(1.0), instance.place, false));
    }
    for (size_t i = 0; i < groups_of_.size(); ++i) {
      if (groups_of_[i].empty() || context_.scene.objects[i].copies.empty()) continue;
      by_file_[i] ? put_file(i) : put_each(i);
    }
  }

 private:
  void add_group(size_t index) {
    const ObjectDefinition& object = context_.scene.objects[index];
    if (!groups_of_[index].empty() || object.shapes.empty()) return;
    const YamlPtr inside =
        shapes_.objects(object.shapes, "object-" + std::to_string(index) + "-", true);
    if (inside == nullptr) return;
    groups_of_[index] = group_names_.add(object.name);
    groups_.put(groups_of_[index], YamlMap{{"objects", inside}});
    by_file_[index] = !object.copies.empty() && !varies(context_, object);
  }

  void put(size_t index, const YamlPtr& steps) {
    YamlMap object{{"instance", yaml_text(groups_of_[index])}};
    if (steps != nullptr) object.put("transform", steps);
    objects_.put(names_.add("instance-" + context_.scene.objects[index].name), object);
  }

  void put_file(size_t index) {
    const Stills stills = stills_of(context_, index);
    const std::string& name = context_.scene.objects[index].name;
    if (!stills.in_file.empty()) {
      const std::string file =
          context_.request.made + "places/object-" + std::to_string(index) + ".ply";
      objects_.put(
          names_.add("instances-" + name),
          YamlMap{{"instance", yaml_text(groups_of_[index])}, {"places", yaml_text(file)}});
    }
    if (!few(index, stills.single.size(), "are too small for a file of places")) return;
    for (const PlaceMatrix& place : stills.single) {
      put(index, transform_node(Mat4d(place_matrix(place))));
    }
  }

  void put_each(size_t index) {
    const ObjectDefinition& object = context_.scene.objects[index];
    if (!few(index, object.still, "hold a medium that varies")) return;
    for (const PlaceMatrix& place : object.copies) {
      put(index, transform_node(context_.to_job * Mat4d(place_matrix(place))));
    }
  }

  /// Whether so many instances can be objects; an error of the report where not.
  bool few(size_t index, size_t count, const std::string& why) {
    if (count <= kMostSingle) return true;
    const ObjectDefinition& object = context_.scene.objects[index];
    context_.report.error(object.place, format_count(count) + " instances of '" + object.name +
                                            "' " + why + "; at most " + format_count(kMostSingle) +
                                            " are possible");
    return false;
  }

  Context& context_;
  Shapes& shapes_;
  YamlMap& groups_;
  YamlMap& objects_;
  Names group_names_, names_;
  std::vector<std::string> groups_of_;  ///< by object; empty: it is nowhere
  std::vector<bool> by_file_;           ///< by object: whether its instances are told by a file
};

}  // namespace

void add_instances(Context& context, Shapes& shapes, YamlMap& groups, YamlMap& objects) {
  Writer(context, shapes, groups, objects).write();
}

Result<Bytes> make_places_file(const LoadedScene& scene, const std::string& name) {
  constexpr std::string_view kBefore = "object-";
  const std::string_view whole = name;
  size_t index = scene.scene.objects.size();
  if (whole.starts_with(kBefore) && whole.ends_with(".ply")) {
    const std::string_view digits = whole.substr(kBefore.size(), whole.size() - kBefore.size() - 4);
    std::from_chars(digits.data(), digits.data() + digits.size(), index);
  }
  if (index >= scene.scene.objects.size() || scene.scene.objects[index].copies.empty()) {
    return Error{"the scene makes no file 'places/" + name + "'"};
  }
  const SceneRequest request;
  return places_bytes(stills_of(Context(scene, request), index).in_file);
}

}  // namespace hyades::core::pbrt
