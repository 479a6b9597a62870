#include "core/import/gltf/read_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/import/gltf/instancing.h"
#include "core/import/gltf/made_meshes.h"
#include "core/import/gltf/materials.h"
#include "core/import/gltf/objects.h"
#include "core/import/gltf/read_model.h"
#include "core/import/gltf/textures.h"
#include "core/import/gltf/views_and_lights.h"

namespace hyades::core {

namespace {

constexpr double kMostFrames = 9'999'999.0;

/// The animation that is meant: the one that was read, if any.
struct Chosen {
  std::shared_ptr<const GltfClip> clip;
  size_t index = 0;
};

class GltfSource : public SceneSource {
 public:
  explicit GltfSource(std::shared_ptr<const GltfModel> model)
      : model_(std::move(model)),
        files_(model_),
        places_(model_),
        images_(image_file_names(*model_)) {}

  Result<SceneSections> sections(const SceneRequest& request) const override;
  Result<Bytes> made_file(const std::string& name) const override;

 private:
  Result<Chosen> choose(const std::string& name) const;

  std::shared_ptr<const GltfModel> model_;
  GltfMeshFiles files_;
  GltfPlaceFiles places_;
  std::vector<std::string> images_;
};

Result<Chosen> GltfSource::choose(const std::string& name) const {
  Chosen chosen;
  if (name == "none" || (name.empty() && model_->animations.empty())) return chosen;
  if (!name.empty()) {
    const int index = files_.animation_named(name);
    if (index < 0) {
      std::string known;
      for (const GltfAnimation& each : model_->animations) {
        known += (known.empty() ? "'" : ", '") + each.name + "'";
      }
      return model_->error("it has no animation '" + name + "'; it has " +
                           (known.empty() ? "none" : known));
    }
    chosen.index = static_cast<size_t>(index);
  }
  auto clip = files_.clip(chosen.index);
  if (!clip) return clip.error();
  chosen.clip = *clip;
  return chosen;
}

void put_unless_empty(YamlMap& sections, const char* key, const YamlMap& map) {
  if (!map.empty()) sections.put(key, map);
}

Result<SceneSections> GltfSource::sections(const SceneRequest& request) const {
  SceneSections out;
  const auto chosen = choose(request.animation);
  if (!chosen) return chosen.error();
  std::vector<std::string> notes = model_->notes;
  GltfStage stage{*model_, request, files_, places_, chosen->clip.get(), chosen->index, {}, notes};
  stage.frames.fps = request.fps;
  if (stage.clip != nullptr) {
    // A key at 1 s is frame 25 of 24 per second, whatever the last bits of its time are.
    const double frames = stage.clip->duration * static_cast<double>(request.fps) + 1e-4;
    stage.frames.last = static_cast<int>(1.0 + std::floor(std::min(frames, kMostFrames)));
  }
  JsonTrouble trouble;
  const JsonValue root = model_->root(trouble);
  GltfTextures textures(*model_, request, images_, notes);
  GltfMaterials materials(*model_, request, textures, notes);
  auto objects = write_objects(stage, materials);
  if (!objects) return objects.error();
  const GltfCamera camera = write_camera(stage, root);
  const YamlMap lights = write_lights(stage, root);
  const JsonTrouble* troubles[] = {&trouble, &materials.trouble(), &textures.trouble()};
  for (const JsonTrouble* each : troubles) {
    if (!each->none()) return model_->error(each->message);
  }
  YamlMap sections;
  if (stage.frames.last > 1) {
    sections.put("frames", YamlMap{{"range", yaml_word(fmt::format("1-{}", stage.frames.last))},
                                   {"fps", yaml_number(request.fps)}});
  }
  put_unless_empty(sections, "film", camera.film);
  put_unless_empty(sections, "camera", camera.camera);
  put_unless_empty(sections, "textures", textures.section());
  put_unless_empty(sections, "materials", materials.materials());
  put_unless_empty(sections, "media", materials.media());
  put_unless_empty(sections, "groups", objects->groups);
  put_unless_empty(sections, "objects", objects->section);
  put_unless_empty(sections, "lights", lights);
  out.sections = sections.node();
  out.bounds = objects->bounds;
  for (const std::string& note : notes) out.notes.push_back(model_->file + ": " + note);
  for (const GltfImage& image : model_->images) {
    if (!image.file.empty()) out.files.push_back(image.file);
  }
  return out;
}

Result<Bytes> GltfSource::made_file(const std::string& name) const {
  if (name.starts_with("places/")) return places_.made(name);
  const auto image = std::find(images_.begin(), images_.end(), name);
  if (image == images_.end() || name.empty()) return files_.made(name);
  const GltfImage& from = model_->images[static_cast<size_t>(image - images_.begin())];
  return from.view >= 0 ? model_->views[static_cast<size_t>(from.view)].bytes : from.bytes;
}

}  // namespace

Result<std::shared_ptr<const SceneSource>> read_gltf(AssetResolver& files,
                                                     const std::string& reference) {
  auto model = read_gltf_model(files, reference);
  if (!model) return model.error();
  return std::shared_ptr<const SceneSource>(std::make_shared<GltfSource>(*model));
}

}  // namespace hyades::core
