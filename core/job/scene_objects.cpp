#include "core/job/scene_objects.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/job/join_trees.h"
#include "core/job/key_index.h"
#include "core/job/output_path.h"
#include "core/job/read_values.h"
#include "core/job/scene_document.h"

namespace hyades::core {

namespace {

using Kind = YamlNode::Kind;

/// Which key brings which files.
struct SceneKey {
  const char* key;
  std::array<const char*, 2> extensions;
};

constexpr std::array<SceneKey, 3> kSceneKeys = {{
    {"gltf", {".glb", ".gltf"}},
    {"pbrt", {".pbrt", ".pbrt"}},
    {"obj", {".obj", ".obj"}},
}};
constexpr std::array<std::string_view, 2> kAnimationKeys = {"animation", "loop"};
constexpr std::array<const char*, 5> kOtherKinds = {"shape", "mesh", "curves", "instance", "group"};
constexpr std::array<const char*, 4> kBroughtSections = {"textures", "materials", "media",
                                                         "groups"};

const SceneKey* scene_key_of(const YamlNode& object) {
  for (const SceneKey& row : kSceneKeys) {
    if (object.find(row.key) != nullptr) return &row;
  }
  return nullptr;
}

bool has_extension(const std::string& name, const SceneKey& row) {
  const std::string extension = file_extension(name);
  return std::find(row.extensions.begin(), row.extensions.end(), extension) != row.extensions.end();
}

YamlPtr map_of(YamlEntry entry, const YamlPlace& where) {
  auto node = std::make_shared<YamlNode>();
  node->kind = Kind::map;
  node->where = where;
  node->map.push_back(std::move(entry));
  return node;
}

class Expander {
 public:
  Expander(const OpenScene& open, float fps, Diagnostics& diagnostics)
      : open_(open), fps_(fps), diagnostics_(diagnostics) {}

  bool changed() const { return changed_; }

  /// A map of objects, those that bring scenes replaced. `path` stands before the objects' names.
  /// `moves`: the transforms around them, from the inside out; null in groups that are instanced.
  YamlPtr objects(const YamlPtr& map, const std::string& path, const std::vector<YamlPtr>* moves) {
    if (map->kind != Kind::map) return map;
    auto result = std::make_shared<YamlNode>(*map);
    for (YamlEntry& entry : result->map) {
      entry.value = object(entry.value, path + entry.key, moves);
    }
    return result;
  }

  /// `root` with what the scenes bring.
  YamlPtr joined(const YamlNode& root) const {
    return join_files(root, *brought_.map(), false, diagnostics_);
  }

 private:
  YamlPtr object(const YamlPtr& node, const std::string& path, const std::vector<YamlPtr>* moves) {
    if (node->kind != Kind::map) return node;
    std::vector<YamlPtr> inner;
    if (moves != nullptr) {
      inner.push_back(node);
      inner.insert(inner.end(), moves->begin(), moves->end());
    }
    const auto* around = moves != nullptr ? &inner : nullptr;
    if (const SceneKey* row = scene_key_of(*node)) return scene(node, *row, path, around);
    const YamlEntry* group = node->find("group");
    if (group == nullptr || group->value->kind != Kind::map) return node;
    const YamlEntry* children = group->value->find("objects");
    if (children == nullptr) return node;
    auto result = std::make_shared<YamlNode>(*node);
    auto body = std::make_shared<YamlNode>(*group->value);
    for (YamlEntry& entry : body->map) {
      if (entry.key == "objects") entry.value = objects(entry.value, path + ".", around);
    }
    for (YamlEntry& entry : result->map) {
      if (entry.key == "group") entry.value = body;
    }
    return result;
  }

  YamlPtr scene(const YamlPtr& node, const SceneKey& row, const std::string& path,
                const std::vector<YamlPtr>* moves) {
    const YamlEntry& file = *node->find(row.key);
    const auto wanted = request(*node, row, path);
    const YamlPtr document = wanted ? open_(*wanted, *file.value, row.key) : nullptr;
    if (document == nullptr) return as_empty_group(*node, file);
    changed_ = true;
    for (const char* section : kBroughtSections) bring(section, *document, nullptr);
    if (moves != nullptr) bring("lights", *document, moves);
    auto result = std::make_shared<YamlNode>(*without_scene_keys(*node));
    const YamlEntry* objects = document->find("objects");
    const YamlPtr children = objects != nullptr ? objects->value : empty(file.value->where);
    result->map.push_back({"group", file.key_where,
                           map_of({"objects", file.key_where, children}, file.value->where)});
    rename_overrides(*result, *document, path);
    return result;
  }

  /// What the object asks for; nothing after a complaint.
  std::optional<SceneDocument> request(const YamlNode& node, const SceneKey& row,
                                       const std::string& path) {
    const YamlEntry& file = *node.find(row.key);
    for (const char* other : kOtherKinds) {
      if (const YamlEntry* second = node.find(other)) {
        diagnostics_.add(second->key_where, "the object has both '" + std::string(row.key) +
                                                "' and '" + other + "', expected one of them");
        return std::nullopt;
      }
    }
    if (file.value->kind != Kind::scalar || !has_extension(file.value->scalar, row)) {
      const std::string hint =
          std::string_view(row.key) == "gltf" ? hint_for_scene_file(file.value->scalar) : "";
      diagnostics_.add(file.value->where, std::string(row.key) + " is " + describe(*file.value) +
                                              ", expected a file whose name ends in " +
                                              row.extensions[0] + hint);
      return std::nullopt;
    }
    SceneDocument wanted;
    wanted.scene = file.value->scalar;
    wanted.prefix = path;
    wanted.fps = fps_;
    if (const YamlEntry* animation = node.find("animation")) {
      if (animation->value->kind != Kind::scalar || animation->value->scalar.empty()) {
        diagnostics_.add(animation->value->where,
                         "animation is " + describe(*animation->value) +
                             ", expected the name of an animation of the file, or none");
        return std::nullopt;
      }
      wanted.animation = animation->value->scalar;
    }
    if (const YamlEntry* loop = node.find("loop")) {
      const std::string& value = loop->value->scalar;
      if (loop->value->kind != Kind::scalar || (value != "true" && value != "false")) {
        diagnostics_.add(loop->value->where,
                         "loop is " + describe(*loop->value) + ", expected true or false");
        return std::nullopt;
      }
      wanted.loop = value == "true";
    }
    for (const std::string_view key : kAnimationKeys) {
      const YamlEntry* entry = node.find(key);
      if (entry == nullptr || std::string_view(row.key) == "gltf") continue;
      diagnostics_.add(entry->key_where, std::string(key) + " is for scenes of glTF, but this is " +
                                             row.key + ": " + wanted.scene);
      return std::nullopt;
    }
    return wanted;
  }

  static YamlPtr without_scene_keys(const YamlNode& node) {
    auto result = std::make_shared<YamlNode>(node);
    std::erase_if(result->map, [](const YamlEntry& entry) {
      const bool scene = std::any_of(kSceneKeys.begin(), kSceneKeys.end(),
                                     [&](const SceneKey& row) { return entry.key == row.key; });
      return scene || std::find(kAnimationKeys.begin(), kAnimationKeys.end(), entry.key) !=
                          kAnimationKeys.end();
    });
    return result;
  }

  static YamlPtr empty(const YamlPlace& where) {
    auto node = std::make_shared<YamlNode>();
    node->kind = Kind::map;
    node->where = where;
    return node;
  }

  /// After a complaint, so that it stays the only one.
  static YamlPtr as_empty_group(const YamlNode& node, const YamlEntry& file) {
    auto result = std::make_shared<YamlNode>(*without_scene_keys(node));
    std::erase_if(result->map, [](const YamlEntry& entry) {
      return entry.key == "override" ||
             std::find(kOtherKinds.begin(), kOtherKinds.end(), entry.key) != kOtherKinds.end();
    });
    result->map.push_back(
        {"group", file.key_where,
         map_of({"objects", file.key_where, empty(file.value->where)}, file.value->where)});
    return result;
  }

  /// Adds a section of the scene to what the job gets; lights are moved as the objects are.
  void bring(const char* section, const YamlNode& document, const std::vector<YamlPtr>* moves) {
    const YamlEntry* entry = document.find(section);
    if (entry == nullptr || entry->value->kind != Kind::map) return;
    YamlPtr value = entry->value;
    if (moves != nullptr) {
      auto moved = std::make_shared<YamlNode>(*value);
      for (YamlEntry& light : moved->map) light.value = moved_light(light.value, *moves);
      value = moved;
    }
    brought_.add(*map_of({section, entry->key_where, value}, value->where), false, diagnostics_);
  }

  /// The light with the steps of the objects around it after its own.
  static YamlPtr moved_light(const YamlPtr& light, const std::vector<YamlPtr>& moves) {
    if (light->kind != Kind::map) return light;
    auto steps = std::make_shared<YamlNode>();
    steps->kind = Kind::list;
    const auto add_steps = [&](const YamlNode& of) {
      const YamlEntry* own = of.find("transform");
      if (own == nullptr || own->value->kind != Kind::list) return;
      steps->where = own->value->where;
      steps->list.insert(steps->list.end(), own->value->list.begin(), own->value->list.end());
    };
    add_steps(*light);
    for (const YamlPtr& move : moves) {
      add_steps(*move);
      if (const YamlEntry* at = move->find("at")) {
        steps->list.push_back(map_of({"translate", at->key_where, at->value}, at->value->where));
      }
    }
    if (steps->list.empty()) return light;
    auto result = std::make_shared<YamlNode>(*light);
    std::erase_if(result->map, [](const YamlEntry& entry) { return entry.key == "transform"; });
    result->map.push_back({"transform", light->where, steps});
    return result;
  }

  /// Materials of the scene go by their own names in `override`.
  static void rename_overrides(YamlNode& object, const YamlNode& document,
                               const std::string& path) {
    const YamlEntry* materials = document.find("materials");
    if (materials == nullptr) return;
    std::optional<KeyIndex> names;
    for (YamlEntry& entry : object.map) {
      if (entry.key != "override" || entry.value->kind != Kind::map) continue;
      if (!names) names.emplace(*materials->value);
      auto renamed = std::make_shared<YamlNode>(*entry.value);
      for (YamlEntry& row : renamed->map) {
        const std::string full = path + "." + row.key;
        if (names->contains(full)) row.key = full;
      }
      entry.value = renamed;
    }
  }

  const OpenScene& open_;
  float fps_;
  Diagnostics& diagnostics_;
  bool changed_ = false;
  JoinedFiles brought_{empty_map()};
};

}  // namespace

float fps_of(const YamlNode& root) {
  const float usual = SceneDocument().fps;
  const YamlEntry* frames = root.kind == Kind::map ? root.find("frames") : nullptr;
  if (frames == nullptr || frames->value->kind != Kind::map) return usual;
  const YamlEntry* fps = frames->value->find("fps");
  double number = 0.0;
  if (fps == nullptr || !parse_number(fps->value->scalar, number) || number <= 0.0) return usual;
  return static_cast<float>(std::min(number, 1e6));
}

YamlPtr with_scene_objects(const YamlPtr& root, const OpenScene& open, Diagnostics& diagnostics) {
  Expander expander(open, fps_of(*root), diagnostics);
  auto result = std::make_shared<YamlNode>(*root);
  for (YamlEntry& section : result->map) {
    if (section.key == "objects") {
      const std::vector<YamlPtr> still;
      section.value = expander.objects(section.value, "", &still);
    } else if (section.key == "groups" && section.value->kind == Kind::map) {
      auto groups = std::make_shared<YamlNode>(*section.value);
      for (YamlEntry& group : groups->map) {
        if (group.value->kind != Kind::map) continue;
        auto body = std::make_shared<YamlNode>(*group.value);
        for (YamlEntry& entry : body->map) {
          if (entry.key != "objects") continue;
          entry.value = expander.objects(entry.value, group.key + ".", nullptr);
        }
        group.value = body;
      }
      section.value = groups;
    }
  }
  return expander.changed() ? expander.joined(*result) : YamlPtr(result);
}

}  // namespace hyades::core
