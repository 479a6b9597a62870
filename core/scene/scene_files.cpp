#include "core/scene/scene_files.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/scene/shape_makers.h"
#include "core/scene/texture_makers.h"

namespace hyades::core {
namespace {

/// Walks from the objects to all that they use. Names that lead nowhere and unknown kinds are left
/// to who builds the scene.
class Walk {
 public:
  explicit Walk(const Job& job) {
    for (const GroupDesc& group : job.groups) groups_.emplace(group.name, &group);
    for (const MaterialDesc& material : job.materials) materials_.emplace(material.name, &material);
    for (const TextureDesc& texture : job.textures) textures_.emplace(texture.name, &texture);
    visit(job.objects, "");
    add_sky(job);
  }

  /// Of all that the job holds. Follows no names, which may lead astray in a job with mistakes.
  static SceneFiles all(const Job& job) {
    Walk walk;
    for (const GroupDesc& group : job.groups) walk.add_meshes(group.objects);
    walk.add_meshes(job.objects);
    for (const TextureDesc& texture : job.textures) walk.add_image(texture);
    walk.add_sky(job);
    return walk.take();
  }

  SceneFiles take() { return std::move(files_); }

 private:
  Walk() = default;

  void add_sky(const Job& job) {
    if (!job.environment) return;
    files_.sky = job.environment->image;
    files_.sky_where = job.environment->where;
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
      }
    }
  }

  void add_mesh(const ObjectDesc& object) {
    if (object.shape != "mesh") return;
    const auto normals = mesh_normals_of(object);
    if (!normals) return;
    const MeshUse use(*normals, object.part);
    if (seen_meshes_.insert({object.mesh, use}).second) {
      files_.meshes.push_back({object.mesh, use, "object '" + object.name + "'", object.where});
    }
  }

  void visit_material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found == materials_.end() || !seen_materials_.insert(name).second) return;
    const MaterialDesc& material = *found->second;
    for (const std::string* texture :
         {&material.color.texture, &material.roughness.texture, &material.reflectiveness.texture,
          &material.glossiness.texture, &material.amount.texture}) {
      visit_texture(*texture);
    }
    visit_material(material.first);
    visit_material(material.second);
    if (material.bump) visit_texture(material.bump->texture);
  }

  void visit_texture(const std::string& name) {
    const auto found = textures_.find(name);
    if (found == textures_.end() || !seen_textures_.insert(name).second) return;
    const TextureDesc& texture = *found->second;
    add_image(texture);
    visit_texture(texture.a.texture);
    visit_texture(texture.b.texture);
  }

  void add_image(const TextureDesc& texture) {
    if (texture.file.empty()) return;
    const auto space = color_space_of(texture);
    if (space && seen_images_.insert({texture.file, *space}).second) {
      files_.images.push_back(
          {texture.file, *space, "texture '" + texture.name + "'", texture.where});
    }
  }

  std::map<std::string, const GroupDesc*> groups_;
  std::map<std::string, const MaterialDesc*> materials_;
  std::map<std::string, const TextureDesc*> textures_;
  std::set<std::pair<std::string, std::string>> seen_groups_;  ///< with the material they inherit
  std::set<std::string> seen_materials_;
  std::set<std::string> seen_textures_;
  std::set<std::pair<std::string, MeshUse>> seen_meshes_;
  std::set<std::pair<std::string, ColorSpace>> seen_images_;
  SceneFiles files_;
};

}  // namespace

SceneFiles files_of_scene(const Job& job) { return Walk(job).take(); }

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
  if (all.sky == some.sky) all.sky.clear();
  return all;
}

Status load_files(const SceneFiles& files, SceneCache& cache, Diagnostics& diagnostics) {
  const size_t meshes = files.meshes.size();
  const size_t images = files.images.size();
  const size_t count = meshes + images + (files.sky.empty() ? 0 : 1);
  std::vector<std::optional<Diagnostic>> failures(count);
  const auto note = [&](size_t i, const auto& loaded, const std::string& user,
                        const SourceLocation& where) {
    if (!loaded) failures[i] = {where, loaded.error().in(user).message};
  };
  const Status all = parallel_for(count, 0, [&](size_t i) {
    if (i < meshes) {
      const auto& mesh = files.meshes[i];
      note(i, cache.mesh(mesh.file, mesh.how), mesh.user, mesh.where);
    } else if (i < meshes + images) {
      const auto& image = files.images[i - meshes];
      note(i, cache.image(image.file, image.how), image.user, image.where);
    } else {
      note(i, cache.environment_map(files.sky), "environment", files.sky_where);
    }
  });
  if (!all) return all;
  for (auto& failure : failures) {
    if (failure) diagnostics.add(failure->where, std::move(failure->message));
  }
  return {};
}

Status load_files(const Job& job, SceneCache& cache) {
  Diagnostics diagnostics;
  if (Status loaded = load_files(files_of_scene(job), cache, diagnostics); !loaded) return loaded;
  if (diagnostics.empty()) return {};
  return diagnostics.to_error();
}

}  // namespace hyades::core
