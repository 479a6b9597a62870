#include "core/scene/scene_files.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/udim.h"
#include "core/job/frame_files.h"
#include "core/job/references.h"
#include "core/scene/environment_makers.h"
#include "core/scene/shape_makers.h"
#include "core/scene/texture_makers.h"

namespace hyades::core {
namespace {

/// Walks from the objects to all that they use. Names that lead nowhere and unknown kinds are left
/// to who builds the scene.
class Walk {
 public:
  Walk(const Job& job, std::optional<int32_t> frame) : extras_(mesh_extras_of(job)) {
    if (frame) add_frame(job, *frame, looks_at_next_frame(job));
    for (const GroupDesc& group : job.groups) groups_.emplace(group.name, &group);
    for (const MaterialDesc& material : job.materials) materials_.emplace(material.name, &material);
    for (const TextureDesc& texture : job.textures) textures_.emplace(texture.name, &texture);
    visit(job.objects, "");
    add_light_maps(job);
  }

  /// Of all that the job holds. Follows no names, which may lead astray in a job with mistakes.
  static SceneFiles all(const Job& job) {
    Walk walk;
    walk.extras_ = mesh_extras_of(job);
    const bool next = looks_at_next_frame(job);
    for (int64_t at = job.frames.first; at <= job.frames.last; at += job.frames.step) {
      // Jobs may have billions of frames, but there are no files for so many.
      if (walk.times_.size() >= kMostFrames) break;
      walk.add_frame(job, static_cast<int32_t>(at), next);
    }
    for (const GroupDesc& group : job.groups) walk.add_meshes(group.objects);
    walk.add_meshes(job.objects);
    for (const TextureDesc& texture : job.textures) walk.add_image(texture);
    walk.add_light_maps(job);
    return walk.take();
  }

  SceneFiles take() { return std::move(files_); }

 private:
  static constexpr size_t kMostFrames = 1'000'000;
  static constexpr size_t kMostFiles = 1'000'000;  ///< the reader lets sequences have so many

  Walk() = default;

  /// Sequences are looked at in `frame`, and in the one after it where that matters (`next`).
  void add_frame(const Job& job, int32_t frame, bool next) {
    times_.push_back(job.time_of(frame));
    if (next) times_.push_back(job.time_of(frame + 1));
  }

  void add_light_maps(const Job& job) {
    for (const LightDesc& light : job.lights) {
      const bool projects = std::holds_alternative<ProjectorLightDesc>(light.kind);
      for (const std::string& image : files_in(light)) {
        add_light_map(image, projects ? LightMap::gobo : LightMap::luminance,
                      "light '" + light.name + "'", light.where);
      }
    }
    if (!job.environment) return;
    add_light_map(
        job.environment->image,
        sky_density(job.integrator) == SkyDensity::excess ? LightMap::excess : LightMap::luminance,
        "environment", job.environment->where);
  }

  void add_light_map(const std::string& file, LightMap how, const std::string& user,
                     const SourceLocation& where) {
    if (file.empty() || !seen_light_maps_.insert({file, how}).second) return;
    files_.light_maps.push_back({file, how, user, where});
  }

  void add_meshes(const std::vector<ObjectDesc>& objects) {
    for (const ObjectDesc& object : objects) {
      add_mesh(object);
      add_meshes(object.children);
    }
  }

  void visit(const std::vector<ObjectDesc>& objects, const std::string& inherited) {
    for (const ObjectDesc& object : objects) {
      const std::string& material = object.material.empty() ? inherited : object.material;
      for (const auto& [from, to] : object.overrides) visit_material(to);
      if (object.shape == "group") {
        visit(object.children, material);
      } else if (object.shape == "instance") {
        const auto group = groups_.find(object.instance_of);
        if (group == groups_.end()) continue;
        if (!seen_groups_.insert({object.instance_of, material}).second) continue;
        visit(group->second->objects, material);
      } else {
        add_mesh(object);
        visit_material(material);
        if (object.emit) visit_texture(object.emit->color.texture);
      }
    }
  }

  void add_mesh(const ObjectDesc& object) {
    if (object.shape != "mesh") return;
    const auto use = may_be_displaced(object) ? Result<MeshUse>(base_use_of(object, extras_))
                                              : mesh_use_of(object, extras_);
    if (!use) return;
    if (may_be_displaced(object)) visit_texture(object.displacement->texture);
    if (!seen_meshes_.insert({object.mesh, *use}).second) return;
    const std::string user = "object '" + object.name + "'";
    if (!is_file_sequence(object.mesh)) {
      files_.meshes.push_back({object.mesh, *use, user, object.where});
      return;
    }
    std::set<std::string> seen;
    for (const JobTime& time : times_) {
      if (files_.meshes.size() > kMostFiles) return;
      const std::string file = frame_file_at(object.mesh, time);
      if (seen.insert(file).second) files_.meshes.push_back({file, *use, user, object.where, true});
    }
  }

  void visit_material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found == materials_.end() || !seen_materials_.insert(name).second) return;
    const MaterialDesc& material = *found->second;
    for (const std::string& texture : names_in(material, NameKind::texture)) visit_texture(texture);
    for (const std::string& part : names_in(material, NameKind::material)) visit_material(part);
  }

  void visit_texture(const std::string& name) {
    const auto found = textures_.find(name);
    if (found == textures_.end() || !seen_textures_.insert(name).second) return;
    const TextureDesc& texture = *found->second;
    add_image(texture);
    for (const std::string& used : names_in(texture, NameKind::texture)) visit_texture(used);
  }

  void add_image(const TextureDesc& texture) {
    const auto* image = std::get_if<textures::Image>(&texture.kind);
    if (image == nullptr || image->file.empty()) return;
    const auto use = image_use_of(*image);
    if (use && seen_images_.insert({image->file, *use}).second) {
      files_.images.push_back({image->file, *use, "texture '" + texture.name + "'", texture.where});
    }
  }

  MeshExtras extras_;
  std::vector<JobTime> times_;  ///< at which sequences are looked at
  std::map<std::string, const GroupDesc*> groups_;
  std::map<std::string, const MaterialDesc*> materials_;
  std::map<std::string, const TextureDesc*> textures_;
  std::set<std::pair<std::string, std::string>> seen_groups_;  ///< with the material they inherit
  std::set<std::string> seen_materials_;
  std::set<std::string> seen_textures_;
  std::set<std::pair<std::string, MeshUse>> seen_meshes_;
  std::set<std::pair<std::string, ImageUse>> seen_images_;
  std::set<std::pair<std::string, LightMap>> seen_light_maps_;
  SceneFiles files_;
};

/// `files` with the files of UDIM patterns in the patterns' places.
SceneFiles with_tiles(SceneFiles files, SceneCache& cache, Diagnostics& diagnostics) {
  std::vector<SceneFile<ImageUse>> images;
  for (const SceneFile<ImageUse>& image : files.images) {
    if (!is_udim(image.file)) {
      images.push_back(image);
      continue;
    }
    const auto tiles = cache.udim(image.file);
    if (!tiles) {
      diagnostics.add(image.where, tiles.error().in(image.user).message);
      continue;
    }
    for (const int tile : **tiles) {
      images.push_back({udim_file(image.file, tile), image.how, image.user, image.where});
    }
  }
  files.images = std::move(images);
  return files;
}

}  // namespace

SceneFiles files_of_scene(const Job& job, std::optional<int32_t> frame) {
  return Walk(job, frame).take();
}

SceneFiles files_of_job(const Job& job) { return Walk::all(job); }

SceneFiles without(SceneFiles all, const SceneFiles& some) {
  const auto remove = [](auto& from, const auto& these) {
    std::erase_if(from, [&](const auto& file) {
      return std::any_of(these.begin(), these.end(), [&](const auto& other) {
        return other.file == file.file && other.how == file.how;
      });
    });
  };
  remove(all.meshes, some.meshes);
  remove(all.images, some.images);
  remove(all.light_maps, some.light_maps);
  return all;
}

Status load_files(const SceneFiles& named, SceneCache& cache, Diagnostics& diagnostics,
                  HeldMeshes* held) {
  const SceneFiles files = with_tiles(named, cache, diagnostics);
  const size_t meshes = files.meshes.size();
  const size_t images = files.images.size();
  const size_t count = meshes + images + files.light_maps.size();
  std::vector<std::optional<Diagnostic>> failures(count);
  HeldMeshes meshes_of_frame(meshes);
  const auto note = [&](size_t i, const auto& loaded, const std::string& user,
                        const SourceLocation& where) {
    if (!loaded) failures[i] = {where, loaded.error().in(user).message};
  };
  const Status all = parallel_for(count, 0, [&](size_t i) {
    if (i < meshes) {
      const auto& mesh = files.meshes[i];
      if (mesh.of_frame && !cache.exists(mesh.file)) return;  // of the frame after the last
      const auto loaded =
          mesh.of_frame ? cache.frame_mesh(mesh.file, mesh.how) : cache.mesh(mesh.file, mesh.how);
      note(i, loaded, mesh.user, mesh.where);
      if (loaded && mesh.of_frame && held != nullptr) meshes_of_frame[i] = *loaded;
    } else if (i < meshes + images) {
      const auto& image = files.images[i - meshes];
      note(i, cache.pyramid(image.file, image.how), image.user, image.where);
    } else {
      const auto& map = files.light_maps[i - meshes - images];
      if (map.how == LightMap::gobo) {
        note(i, cache.gobo(map.file), map.user, map.where);
      } else {
        const auto density =
            map.how == LightMap::excess ? SkyDensity::excess : SkyDensity::luminance;
        note(i, cache.environment_map(map.file, density), map.user, map.where);
      }
    }
  });
  if (!all) return all;
  for (auto& failure : failures) {
    if (failure) diagnostics.add(failure->where, std::move(failure->message));
  }
  if (held != nullptr) *held = std::move(meshes_of_frame);
  return {};
}

Result<HeldMeshes> load_files(const Job& job, std::optional<int32_t> frame, SceneCache& cache) {
  Diagnostics diagnostics;
  HeldMeshes held;
  if (Status loaded = load_files(files_of_scene(job, frame), cache, diagnostics, &held); !loaded) {
    return loaded.error();
  }
  if (diagnostics.empty()) return held;
  return diagnostics.to_error();
}

}  // namespace hyades::core
