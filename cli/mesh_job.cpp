#include "cli/mesh_job.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/geometry/read_mesh.h"

namespace hyades::cli {

using core::Animated;
using core::Rgb;
using core::Vec3;

namespace {

core::MaterialDesc lambert(const std::string& name, const Rgb& color) {
  core::MaterialDesc material;
  material.name = name;
  material.type = "lambert";
  material.color.value = Animated<Rgb>(color);
  return material;
}

/// A name for files and folders out of a mesh file's: what is not a letter, a digit or one of _-.
/// becomes '-', and it begins with a letter or digit, so that it can neither hide nor lead out of a
/// folder.
std::string safe_name(const std::string& stem) {
  std::string name;
  for (const char c : stem) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || (!name.empty() && (c == '_' || c == '-' || c == '.'))) {
      name += c;
    } else if (!name.empty()) {
      name += '-';
    }
  }
  return name.empty() ? "mesh" : name;
}

}  // namespace

core::Result<core::Job> make_mesh_job(const std::string& reference, core::AssetResolver& assets) {
  auto mesh = core::read_mesh(assets, reference);
  if (!mesh) return mesh.error();
  const core::Bounds bounds = (*mesh)->bounds;
  if (bounds.empty()) return core::Error{reference + ": the mesh has no triangles"};
  const Vec3 center = bounds.center();
  const float radius = std::max(0.5F * std::sqrt(glm::dot(bounds.size(), bounds.size())), 1e-20F);

  core::Job job;
  job.name = safe_name(std::filesystem::path(reference).stem().string());
  job.film.width = 960;
  job.film.height = 720;
  job.materials = {lambert("clay", {0.60F, 0.45F, 0.35F}), lambert("ground", Rgb(0.35F))};

  core::ObjectDesc object;
  object.name = job.name;
  object.shape = "mesh";
  object.mesh = reference;
  object.material = "clay";
  core::ObjectDesc ground;
  ground.name = object.name == "ground" ? "floor" : "ground";
  ground.shape = "disk";
  ground.radius = 40.0F * radius;
  ground.at = Animated<Vec3>({center.x, bounds.lower.y - 1e-4F * radius, center.z});
  ground.material = "ground";
  core::ObjectDesc key;  // a large soft light over the viewer's left shoulder
  key.name = object.name == "key" ? "lamp" : "key";
  key.shape = "sphere";
  key.radius = 0.8F * radius;
  key.at = Animated<Vec3>(center + radius * Vec3(-3.0F, 4.5F, 3.5F));
  key.visible_to_camera = false;
  key.emit = core::EmitDesc{};
  key.emit->color = Animated<Rgb>({1.0F, 0.93F, 0.82F});
  key.emit->amount = Animated<float>(30.0F);
  job.objects = {object, ground, key};

  job.environment = core::EnvironmentDesc{};
  job.environment->color = Animated<Rgb>({0.55F, 0.65F, 0.80F});
  job.environment->strength = Animated<float>(0.8F);

  job.camera.fov = Animated<float>(30.0F);
  // The bounding sphere fills the height of the view, a little air included.
  const float distance = 1.02F * radius / 0.2588F;  // sin of half the field of view
  job.camera.look_from = Animated<Vec3>(center + distance * Vec3(0.48F, 0.32F, 0.8165F));
  job.camera.look_at = Animated<Vec3>(center);

  core::OutputDesc exr;
  exr.file = job.name + ".exr";
  exr.layers = {"beauty", "alpha"};
  core::OutputDesc png;
  png.file = job.name + ".png";
  png.tone_map = "filmic";
  job.outputs = {exr, png};
  return job;
}

}  // namespace hyades::cli
