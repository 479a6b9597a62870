#include "import/pbrt/read_pbrt.h"

#include <utility>
#include <vector>

#include "import/pbrt/camera.h"
#include "import/pbrt/grid_media.h"
#include "import/pbrt/instances.h"
#include "import/pbrt/lights.h"
#include "import/pbrt/mesh_files.h"
#include "import/pbrt/pictured_lights.h"
#include "import/pbrt/read_scene_text.h"
#include "import/pbrt/render_sections.h"
#include "import/pbrt/shapes.h"
#include "import/pbrt/sky.h"

namespace hyades::core {
namespace pbrt {
namespace {

/// Opens what made files are made from, while there is somebody to open it.
class Loader {
 public:
  Loader(const SceneFiles& files, LoadedScene& loaded) : files_(files), loaded_(loaded) {}

  Status load() {
    const ParsedScene& scene = loaded_.scene;
    for (const Entity* entity : {&scene.film, &scene.filter, &scene.integrator}) add(*entity);
    add(scene.camera);
    for (const Entity& material : scene.materials) add(material);
    for (const Entity& light : scene.area_lights) add(light);
    for (const auto* list :
         {&scene.named_materials, &scene.float_textures, &scene.spectrum_textures, &scene.media}) {
      for (const NamedEntity& entity : *list) add(entity);
    }
    for (const NamedEntity& texture : scene.float_textures) {
      if (texture.type == "imagemap") add_file(texture);
    }
    for (const NamedEntity& medium : scene.media) add_file(medium);
    for (const LightEntity& light : scene.lights) {
      add(light);
      if (light.type != "point" && light.type != "spot" && light.type != "distant") add_file(light);
    }
    if (scene.camera.type == "realistic") add_file(scene.camera, "lensfile");
    add_reversed(scene.shapes);
    for (const ObjectDefinition& object : scene.objects) add_reversed(object.shapes);
    look_for_files();
    return status_;
  }

 private:
  void add(const Entity& entity) {
    for (const ParameterPtr& p : entity.parameters) {
      if (p->type != "spectrum" || p->texts.empty() || is_named_spectrum(p->texts[0])) continue;
      const std::string& name = p->texts[0];
      if (loaded_.spectra.contains(name) || !status_) continue;
      auto bytes = files_.open(name);
      if (!bytes) {
        status_ = p->place.error(bytes.error().message);
        return;
      }
      auto spectrum = read_spd({bytes->chars(), bytes->size()});
      if (!spectrum) {
        status_ = p->place.error(name + ": " + spectrum.error().message);
        return;
      }
      loaded_.spectra.emplace(name, std::move(*spectrum));
    }
  }

  /// What is missing is an error when somebody asks for what is made of it.
  void add_file(const Entity& entity, const char* name = "filename") {
    Report unheard;
    ParameterReader reader(entity.parameters, entity.place, unheard);
    const std::string file = reader.text(name);
    if (file.empty() || loaded_.files.contains(file)) return;
    auto bytes = files_.open(file);
    if (bytes) {
      loaded_.files.emplace(file, std::move(*bytes));
    } else {
      loaded_.missing.emplace(file, bytes.error().message);
    }
  }

  void add_reversed(const std::vector<ShapeEntity>& shapes) {
    for (const ShapeEntity& shape : shapes) {
      if (shape.reversed && shape.type == "plymesh") add_file(shape);
    }
  }

  /// Of files that jobs are to open, so that those that are missing are told with their places.
  void look_for_files() {
    const ParsedScene& scene = loaded_.scene;
    const auto look = [&](const auto& entities) {
      for (const Entity& entity : entities) look_for(entity);
    };
    look(scene.materials);
    look(scene.named_materials);
    look(scene.area_lights);
    look(scene.float_textures);
    look(scene.spectrum_textures);
    look(scene.shapes);
    for (const ObjectDefinition& object : scene.objects) look(object.shapes);
  }

  void look_for(const Entity& entity) {
    for (const ParameterPtr& p : entity.parameters) {
      if (p->type != "string" || (p->name != "filename" && p->name != "normalmap")) continue;
      for (const std::string& file : p->texts) {
        if (loaded_.files.contains(file) || files_.exists(file)) continue;
        // Something may stand in for it.
        const auto bytes = files_.open(file);
        if (!bytes) loaded_.missing.emplace(file, bytes.error().message);
      }
    }
  }

  const SceneFiles& files_;
  LoadedScene& loaded_;
  Status status_;
};

class PbrtSource : public SceneSource {
 public:
  explicit PbrtSource(LoadedScene loaded) : loaded_(std::move(loaded)) {}

  Result<SceneSections> sections(const SceneRequest& request) const override {
    Context context(loaded_, request);
    YamlMap out;
    add_render_sections(context, out);
    add_camera(context, out);
    Textures textures(context);
    YamlMap scene;
    add_objects(context, textures, scene);
    add_lights(context, scene);
    for (const auto& [name, map] : {std::pair("textures", &context.textures),
                                    {"materials", &context.materials},
                                    {"media", &context.media}}) {
      if (!map->empty()) out.put(name, *map);
    }
    const YamlPtr made = scene.node();
    for (const YamlEntry& entry : made->map) out.put(entry.key, entry.value);
    if (!context.lights.empty()) out.put("lights", context.lights);
    if (!context.report.errors.empty()) {
      std::string all;
      for (const std::string& error : context.report.errors) {
        all += (all.empty() ? "" : "\n") + error;
      }
      return Error{all};
    }
    return SceneSections{
        out.node(), {}, std::move(context.report.notes), std::move(context.files), true};
  }

  Result<Bytes> made_file(const std::string& name) const override {
    if (name == "sky.exr") return make_sky(loaded_);
    if (name.starts_with("lights/")) return make_light_picture(loaded_, name.substr(7));
    if (name.starts_with("media/")) return make_medium_file(loaded_, name.substr(6));
    if (name.starts_with("places/")) return make_places_file(loaded_, name.substr(7));
    if (name.starts_with("meshes/")) return make_mesh_file(loaded_, name.substr(7));
    return Error{"the scene makes no file '" + name + "'"};
  }

 private:
  LoadedScene loaded_;
};

}  // namespace
}  // namespace pbrt

Result<std::shared_ptr<const SceneSource>> read_pbrt(AssetResolver& files,
                                                     const std::string& reference) {
  const pbrt::SceneFiles scene_files(files, reference);
  auto scene = pbrt::read_scene_text(scene_files);
  if (!scene) return scene.error();
  pbrt::LoadedScene loaded;
  loaded.scene = std::move(*scene);
  if (Status s = pbrt::Loader(scene_files, loaded).load(); !s) return s.error();
  return std::shared_ptr<const SceneSource>(
      std::make_shared<const pbrt::PbrtSource>(std::move(loaded)));
}

}  // namespace hyades::core
