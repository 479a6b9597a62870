#include "cli/mesh_job.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/mesh_parts.h"

namespace hyades::cli {

using core::Rgb;
using core::Vec3;

namespace {

/// Any text as YAML holds it.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A name as YAML holds it: all are plain text, but for the one that means nothing there.
std::string named(const std::string& name) {
  return name == "null" || name == "Null" || name == "NULL" ? quoted(name) : name;
}

std::string list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

bool any(const ShownMesh& mesh, bool (*holds)(const ShownPart&)) {
  return std::any_of(mesh.parts.begin(), mesh.parts.end(), holds);
}

/// "material: NAME, " and the material's line; nothing where the medium brings a surface.
std::string surface(const ShownPart& part, std::string& materials) {
  if (!part.medium.empty() && part.has_index) return "";
  const auto line = [&](const std::string& value) {
    materials += fmt::format("  {}: {}\n", named(part.name), value);
    return ", material: " + named(part.name);
  };
  if (part.look.clear) return line(fmt::format("{{type: dielectric, ior: {}}}", part.look.index));
  if (!part.medium.empty()) return line("{type: \"null\"}");
  if (!core::is_black(part.look.emission)) return line("{type: black}");
  const std::string color = list(part.look.diffuse.value_or(Rgb(0.60F, 0.45F, 0.35F)));
  return line(fmt::format("{{type: lambert, color: {}}}", color));
}

std::string object(const ShownPart& part, const std::string& file, std::string& materials) {
  std::string text = fmt::format("  {}: {{mesh: {}", named(part.name), quoted(file));
  if (!part.part.empty()) text += ", part: " + quoted(part.part);
  text += surface(part, materials);
  if (!part.medium.empty()) text += ", interior: " + named(part.medium);
  if (!core::is_black(part.look.emission)) {
    text += fmt::format(", emit: {{color: {}, radiance: 1, two_sided: true}}",
                        list(part.look.emission));
  }
  return text + "}\n";
}

/// `wanted`, or something like it that no part has.
std::string free_name(const ShownMesh& mesh, std::string wanted) {
  while (std::any_of(mesh.parts.begin(), mesh.parts.end(),
                     [&](const ShownPart& part) { return part.name == wanted; })) {
    wanted += "-2";
  }
  return wanted;
}

}  // namespace

core::Result<std::string> mesh_job_text(const MeshJobFiles& files, core::AssetResolver& assets) {
  const auto shown = show_mesh(files.mesh, files.media, assets);
  if (!shown) return shown.error();
  const core::Bounds& bounds = shown->bounds;
  const Vec3 center = bounds.center();
  const float radius = std::max(0.5F * std::sqrt(glm::dot(bounds.size(), bounds.size())), 1e-18F);
  const bool has_media = any(*shown, [](const ShownPart& part) { return !part.medium.empty(); });
  const bool shines =
      any(*shown, [](const ShownPart& part) { return !core::is_black(part.look.emission); });

  const std::string name = safe_name(std::filesystem::path(files.mesh).stem().string());
  std::string text = fmt::format("hyades: 1\nname: {}\nfilm: {{size: [960, 720]}}\n", named(name));
  // Light in media scatters very often before it comes out, and comes out noisily.
  if (has_media) text += "sampling: {samples: 256}\nintegrator: {type: path, max_depth: 4096}\n";
  // The bounding sphere fills the height of the view, a little air included.
  const float distance = 1.02F * radius / 0.2588F;  // sin of half the field of view
  text += fmt::format("camera: {{look_from: {}, look_at: {}, fov: 30}}\n",
                      list(center + distance * Vec3(0.48F, 0.32F, 0.8165F)), list(center));
  if (!files.media.empty()) text += fmt::format("media: {{file: {}}}\n", quoted(files.media));

  std::string materials;
  std::string objects;
  for (const ShownPart& part : shown->parts) objects += object(part, files.mesh, materials);
  const std::string ground = free_name(*shown, "ground");
  materials += fmt::format("  {}: {{type: lambert, color: 0.35}}\n", ground);
  objects += fmt::format("  {}: {{shape: disk, radius: {}, at: {}, material: {}}}\n", ground,
                         40.0F * radius,
                         list({center.x, bounds.lower.y - 1e-4F * radius, center.z}), ground);
  if (!shines) {
    // A large soft light over the viewer's left shoulder; larger for what only chance lets light
    // into.
    const float size = has_media ? 2.0F : 0.8F;
    objects += fmt::format(
        "  {}: {{shape: sphere, radius: {}, at: {}, visible_to_camera: false, emit: {{color: [1, "
        "0.93, 0.82], radiance: {}}}}}\n",
        free_name(*shown, "key"), size * radius, list(center + radius * Vec3(-3.0F, 4.5F, 3.5F)),
        has_media ? 4.8F : 30.0F);
  }
  text += "materials:\n" + materials + "objects:\n" + objects;
  text +=
      fmt::format("environment: {{color: [0.55, 0.65, 0.8], strength: {}}}\n", shines ? 0.1 : 0.8);
  text += fmt::format(
      "outputs:\n  - {{file: {}, layers: [beauty, alpha]}}\n  - {{file: {}, tone_map: filmic}}\n",
      quoted(name + ".exr"), quoted(name + ".png"));
  return text;
}

}  // namespace hyades::cli
