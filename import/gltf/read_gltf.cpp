#include "import/gltf/read_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "import/gltf/instancing.h"
#include "import/gltf/left_out.h"
#include "import/gltf/made_meshes.h"
#include "import/gltf/materials.h"
#include "import/gltf/objects.h"
#include "import/gltf/read_model.h"
#include "import/gltf/textures.h"
#include "import/gltf/views_and_lights.h"

namespace hyades::core {

namespace {

constexpr double kMostPoses = 9'999'999.0;

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
        places_(model_, files_),
        images_(image_file_names(*model_)) {}

  Result<SceneSections> sections(const SceneRequest& request) const override;
  Result<Bytes> made_file(const std::string& name) const override;

 private:
  Result<Chosen> choose(const std::string& name) const;
  void note_others(size_t played, const std::string& asked, std::vector<std::string>& notes) const;

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

/// Where nobody has chosen, the animations that might have been.
void GltfSource::note_others(size_t played, const std::string& asked,
                             std::vector<std::string>& notes) const {
  constexpr size_t kMost = 12;
  const std::vector<GltfAnimation>& all = model_->animations;
  if (!asked.empty() || all.size() < 2) return;
  const auto name_of = [&](size_t i) {
    return all[i].name.empty() ? files_.clip_name(i) : all[i].name;
  };
  std::string others;
  for (size_t i = 0, told = 0; i < all.size(); ++i) {
    if (i == played) continue;
    if (told++ == kMost) {
      others += fmt::format(" and {} more", all.size() - 1 - kMost);
      break;
    }
    others += (others.empty() ? "'" : ", '") + name_of(i) + "'";
  }
  notes.push_back(fmt::format("of its {} animations '{}' is played; others: {}", all.size(),
                              name_of(played), others));
}

void put_unless_empty(YamlMap& sections, const char* key, const YamlMap& map) {
  if (!map.empty()) sections.put(key, map);
}

Result<SceneSections> GltfSource::sections(const SceneRequest& request) const {
  SceneSections out;
  const auto chosen = choose(request.animation);
  if (!chosen) return chosen.error();
  if (model_->is_too_much(files_.elements())) {
    return model_->error(fmt::format(
        "its meshes have {} vertices or triangles together, which is too much for {} bytes",
        files_.elements(), model_->buffer_bytes));
  }
  std::vector<std::string> notes = model_->notes;
  GltfStage stage{*model_, request, files_, places_, chosen->clip.get(), chosen->index, {}, notes};
  stage.frames.fps = request.fps;
  if (stage.clip != nullptr) {
    // A key at 1 s is frame 25 of 24 per second, whatever the last bits of its time are.
    const double frames =
        std::min(stage.clip->duration * static_cast<double>(request.fps), kMostPoses);
    stage.frames.last = static_cast<int>(1.0 + std::floor(frames + 1e-4));
    if (request.loop && frames > 0.0) {
      stage.frames.seam = 1.0 + frames;
      // The frame at the seam is the first one again.
      stage.frames.last = static_cast<int>(std::max(1.0, std::ceil(frames - 1e-4)));
    }
  }
  note_others(chosen->index, request.animation, notes);
  for (const std::string& note : left_out_attributes(*model_)) notes.push_back(note);
  if (stage.clip != nullptr) {
    notes.insert(notes.end(), stage.clip->notes.begin(), stage.clip->notes.end());
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
  if (sections.empty() && model_->images.empty()) {
    return model_->error("nothing is to be seen: expected nodes with meshes in its scene");
  }
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
