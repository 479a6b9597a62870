#include "import/scene_job.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/job/yaml_build.h"
#include "import/fill_with_media.h"
#include "import/names.h"

namespace hyades::core {

namespace {

using Kind = YamlNode::Kind;

/// Section `key` of a tree; an empty map where there is none.
const YamlNode& section_of_job(const YamlNode& tree, const char* key) {
  const YamlEntry* entry = tree.find(key);
  return entry != nullptr ? *entry->value : empty_map();
}

/// The number that an entry says; 1 where it says something else, a texture, keys or an expression.
double number_in(const YamlNode& entry) {
  double number = 1.0;
  const std::string& text = entry.scalar;
  if (entry.kind == Kind::scalar) std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// The largest of the numbers of a colour.
double brightest(const YamlNode& color) {
  if (color.kind != Kind::list) return number_in(color);
  double most = 0.0;
  for (const YamlPtr& part : color.list) most = std::max(most, number_in(*part));
  return most;
}

/// Whether what gives off more than `least` lights a scene; `color` and `strength` are 1 where they
/// are null.
bool lights_up(const YamlEntry* color, const YamlEntry* strength, double least) {
  const double amount = strength == nullptr ? 1.0 : number_in(*strength->value);
  return amount * (color == nullptr ? 1.0 : brightest(*color->value)) > least;
}

/// Whether an object, or one in its groups, lights the scene.
bool shines(const YamlNode& objects, double least) {
  return std::any_of(objects.map.begin(), objects.map.end(), [&](const YamlEntry& entry) {
    const YamlNode& object = *entry.value;
    if (object.kind != Kind::map) return false;
    if (const YamlEntry* group = object.find("group");
        group != nullptr && shines(section_of_job(*group->value, "objects"), least)) {
      return true;
    }
    const YamlEntry* emit = object.find("emit");
    if (emit == nullptr) return false;
    const YamlNode& how = *emit->value;
    return how.find("power") != nullptr ||
           lights_up(how.find("color"), how.find("radiance"), least);
  });
}

bool has_lamps(const YamlNode& scene) {
  return scene.find("environment") != nullptr || scene.find("lights") != nullptr;
}

/// Whether the scene has light of its own; of surfaces, what gives off more than `least`.
bool has_light(const YamlNode& scene, double least) {
  if (has_lamps(scene)) return true;
  const auto any_of = [&](const char* section, const auto& test) {
    const YamlNode& things = section_of_job(scene, section);
    return std::any_of(things.map.begin(), things.map.end(), [&](const YamlEntry& entry) {
      return entry.value->kind == Kind::map && test(*entry.value);
    });
  };
  const auto glows = [&](const YamlNode& material) {
    const YamlEntry* strength = material.find("emission_strength");
    return strength != nullptr && lights_up(material.find("emission_color"), strength, least);
  };
  const auto burns = [](const YamlNode& medium) { return medium.find("emission") != nullptr; };
  const auto holds_lamps = [&](const YamlNode& group) {
    return shines(section_of_job(group, "objects"), least);
  };
  return any_of("materials", glows) || any_of("media", burns) ||
         shines(section_of_job(scene, "objects"), least) || any_of("groups", holds_lamps);
}

bool has_interiors(const YamlNode& objects) {
  return std::any_of(objects.map.begin(), objects.map.end(), [](const YamlEntry& entry) {
    return entry.value->kind == Kind::map && entry.value->find("interior") != nullptr;
  });
}

/// `wanted`, or something like it that `section` does not have.
std::string free_name(const YamlNode& section_of_job, std::string wanted) {
  while (section_of_job.find(wanted) != nullptr) wanted += "-2";
  return wanted;
}

/// A place and a size to stage the scene for.
struct Extent {
  Vec3 center{0.0F};
  float radius = 1.0F;
  float floor = 0.0F;  ///< height of the lowest point

  explicit Extent(const Bounds& bounds) {
    if (bounds.empty()) return;
    center = bounds.center();
    const Vec3 size = bounds.size();
    radius = std::max(0.5F * std::sqrt(glm::dot(size, size)), 1e-18F);
    floor = bounds.lower.y;
  }

  /// A place or length to about a hundredth of the size: numbers that a person can read.
  Vec3 rounded(const Vec3& v) const {
    const double unit = std::pow(10.0, std::floor(std::log10(static_cast<double>(radius))) - 2.0);
    return Vec3(glm::round(Vec3d(v) / unit) * unit);
  }
};

YamlPtr camera(const Extent& extent) {
  // The bounding sphere fills the height of the view, a little air included.
  const float distance = 1.02F * extent.radius / 0.2588F;  // sin of half the field of view
  const Vec3 from = extent.center + distance * Vec3(0.48F, 0.32F, 0.8165F);
  return YamlMap{{"look_from", yaml_vector(extent.rounded(from))},
                 {"look_at", yaml_vector(extent.rounded(extent.center))},
                 {"fov", yaml_integer(30)}}
      .node();
}

YamlPtr ground(const Extent& extent, const std::string& material) {
  const Vec3 at = {extent.center.x, extent.floor - 1e-4F * extent.radius, extent.center.z};
  return YamlMap{{"shape", yaml_word("disk")},
                 {"radius", yaml_number(extent.rounded(Vec3(40.0F * extent.radius)).x)},
                 {"at", yaml_vector(at)},
                 {"material", yaml_text(material)}}
      .node();
}

/// A large soft light over the viewer's left shoulder; larger for what only chance lets light into.
YamlPtr key_light(const Extent& extent, bool has_media) {
  const float size = has_media ? 2.0F : 0.8F;
  const Vec3 at = extent.center + extent.radius * Vec3(-3.0F, 4.5F, 3.5F);
  const YamlMap emit{{"color", yaml_vector({1.0F, 0.93F, 0.82F})},
                     {"radiance", yaml_number(has_media ? 4.8F : 30.0F)}};
  return YamlMap{{"shape", yaml_word("sphere")},
                 {"radius", yaml_number(extent.rounded(Vec3(size * extent.radius)).x)},
                 {"at", yaml_vector(extent.rounded(at))},
                 {"visible_to_camera", yaml_flag(false)},
                 {"emit", emit.node()}}
      .node();
}

YamlPtr sky(float strength) {
  return YamlMap{{"color", yaml_vector({0.55F, 0.65F, 0.8F})}, {"strength", yaml_number(strength)}}
      .node();
}

YamlPtr outputs(const std::string& name, bool animated) {
  const std::string stem = animated ? name + ".####" : name;
  const YamlMap exr{{"file", yaml_text(stem + ".exr")},
                    {"layers", yaml_list({yaml_word("beauty"), yaml_word("alpha")})}};
  const YamlMap png{{"file", yaml_text(stem + ".png")}, {"tone_map", yaml_word("filmic")}};
  return yaml_list({exr.node(), png.node()});
}

bool is_animated(const YamlNode& scene) {
  const YamlEntry* range = section_of_job(scene, "frames").find("range");
  return range != nullptr && range->value->scalar.find('-') != std::string::npos;
}

/// Sections that a job has in this order; what else a scene brings comes after them.
void put_head(YamlMap& job, const YamlNode& scene, const std::string& name, bool has_media) {
  job.put("hyades", yaml_integer(1)).put("name", yaml_text(name));
  const auto own_or = [&](const char* key, const YamlPtr& otherwise) {
    const YamlEntry* own = scene.find(key);
    if (own != nullptr) {
      job.put(key, own->value);
    } else if (otherwise != nullptr) {
      job.put(key, otherwise);
    }
  };
  own_or("units", nullptr);
  own_or("frames", nullptr);
  const YamlPtr size = yaml_list({yaml_integer(960), yaml_integer(720)});
  own_or("film", YamlMap{{"size", size}}.node());
  // Light in media scatters very often before it comes out, and comes out noisily.
  const YamlMap many{{"samples", yaml_integer(256)}};
  const YamlMap deep{{"type", yaml_word("path")}, {"max_depth", yaml_integer(4096)}};
  own_or("sampling", has_media ? many.node() : nullptr);
  own_or("integrator", has_media ? deep.node() : nullptr);
}

/// White paper in full light gives off as much; labels, screens and what is to look the same in any
/// light do.
constexpr double kDim = 1.0;

/// The job; `added` gets what the scene does not say itself.
YamlPtr staged(const YamlNode& scene, const SceneSections& told, const std::string& name,
               std::vector<std::string>& added) {
  const Extent extent(told.bounds);
  const YamlNode& own = section_of_job(scene, "objects");
  const YamlNode& groups = section_of_job(scene, "groups");
  const bool has_media =
      has_interiors(own) ||
      std::any_of(groups.map.begin(), groups.map.end(), [](const YamlEntry& group) {
        return has_interiors(section_of_job(*group.value, "objects"));
      });
  const bool lit = has_light(scene, told.emitters_are_lamps ? 0.0 : kDim);
  const bool seen = scene.find("camera") != nullptr;
  YamlMap job;
  put_head(job, scene, name, has_media);
  job.put("camera", seen ? scene.find("camera")->value : camera(extent));
  if (!seen) added.emplace_back("camera");
  YamlMap materials;
  YamlMap objects;
  for (const YamlEntry& entry : section_of_job(scene, "materials").map) {
    materials.put(entry.key, entry.value);
  }
  for (const YamlEntry& entry : own.map) objects.put(entry.key, entry.value);
  if (!seen && scene.find("environment") == nullptr) {
    const std::string look = free_name(section_of_job(scene, "materials"), "ground");
    materials.put(look, YamlMap{{"type", yaml_word("lambert")}, {"color", yaml_number(0.35F)}});
    objects.put(free_name(own, "ground"), ground(extent, look));
    added.push_back("objects." + free_name(own, "ground"));
  }
  if (!lit) {
    objects.put(free_name(own, "key"), key_light(extent, has_media));
    added.push_back("objects." + free_name(own, "key"));
  }
  for (const YamlEntry& entry : scene.map) {
    if (!job.has(entry.key) && entry.key != "materials" && entry.key != "objects") {
      job.put(entry.key, entry.value);
    }
  }
  if (!materials.empty()) job.put("materials", materials);
  job.put("objects", objects);
  if (!job.has("environment") && !(lit && seen)) {
    job.put("environment", sky(lit ? 0.1F : 0.8F));
    added.emplace_back("environment");
  }
  job.put("outputs", outputs(name, is_animated(scene)));
  return job.node();
}

/// `scene` with the sections of `first` before its own.
YamlPtr with_sections(const YamlNode& first, const YamlNode& scene) {
  auto result = std::make_shared<YamlNode>(first);
  result->map.insert(result->map.end(), scene.map.begin(), scene.map.end());
  result->weight += scene.weight;
  return result;
}

}  // namespace

Result<SceneJob> scene_job(AssetResolver& files, const SceneJobRequest& request) {
  const auto source = read_scene(files, request.scene);
  if (!source) return source.error();
  auto told = (*source)->sections(request.how);
  if (!told) return told.error();
  YamlPtr scene = told->sections;
  if (!request.media.empty()) {
    auto filled =
        fill_with_media(*scene, {request.media, request.media_in_job}, request.scene, files);
    if (!filled) return filled.error();
    scene = *filled;
  }
  const std::string stem = std::filesystem::path(request.scene).stem().string();
  SceneJob job{nullptr, *source, std::move(told->notes), std::move(told->files), {}};
  // A script says all that a job would, but need not say in which version of the language.
  if (is_script_file(request.scene)) {
    const YamlMap version{{"hyades", yaml_integer(1)}};
    job.tree = scene->find("hyades") != nullptr ? scene : with_sections(*version.node(), *scene);
    return job;
  }
  if (!told->emitters_are_lamps && !has_lamps(*scene) && has_light(*scene, kDim)) {
    job.notes.push_back(request.scene +
                        ": it has no lamps; what its surfaces emit, some of them more than paper "
                        "in full light, is all the light that there is");
  }
  job.tree = staged(*scene, *told, safe_name(stem, "scene"), job.added);
  return job;
}

}  // namespace hyades::core
