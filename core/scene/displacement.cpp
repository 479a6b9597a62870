#include "core/scene/displacement.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry/displace.h"
#include "core/job/field_writer.h"
#include "core/job/frame_files.h"
#include "core/job/references.h"
#include "core/job/resolved_parts.h"
#include "core/scene/shape_makers.h"

namespace hyades::core {
namespace {

/// Those that a displacement reads: its own and what that is made of, each once.
std::vector<const TextureDesc*> textures_read(const Job& job, const std::string& first) {
  std::vector<const TextureDesc*> found;
  std::vector<std::string> names = {first};
  while (!names.empty()) {
    const std::string name = std::move(names.back());
    names.pop_back();
    const auto texture = std::find_if(job.textures.begin(), job.textures.end(),
                                      [&](const TextureDesc& t) { return t.name == name; });
    if (texture == job.textures.end()) continue;
    if (std::find(found.begin(), found.end(), &*texture) != found.end()) continue;
    found.push_back(&*texture);
    for (const std::string& used : names_in(*texture, NameKind::texture)) names.push_back(used);
  }
  return found;
}

bool looks_at_world(const TextureDesc& texture) {
  const textures::Mapping mapping = mapping_of(texture);
  return mapping.type == "world" || mapping.space == "world";
}

/// Colours and second coordinates of vertices are known of surfaces, and not while one is made.
bool looks_at_vertices(const TextureDesc& texture) {
  return std::holds_alternative<textures::VertexColor>(texture.kind) ||
         mapping_of(texture).type == "uv1";
}

bool looks_at_uv(const TextureDesc& texture) {
  const std::string type = mapping_of(texture).type;
  const bool on_uv = std::visit([](const auto& kind) { return kind.kTraits.on_uv; }, texture.kind);
  return type == "uv" || (type == "default" && on_uv);
}

/// All that decides the mesh.
std::string key_of(const ObjectDesc& object, const DisplacementSetting& setting,
                   const std::vector<const TextureDesc*>& textures) {
  FieldWriter out({setting.looks.time()}, {});
  out.put("mesh", frame_file_at(object.mesh, setting.looks.time()));
  out.put("part", object.part);
  out.put("normals", object.smooth);
  out.put("tangents", setting.extras.tangents);
  out.map("displacement", "", object.displacement);
  for (const TextureDesc* texture : textures) write_texture(out, *texture);
  if (std::any_of(textures.begin(), textures.end(),
                  [](const TextureDesc* texture) { return looks_at_world(*texture); })) {
    out.put("units", setting.looks.units());
    out.put("to_world", setting.to_world);
  }
  return out.take();
}

float default_edge(const TriangleMesh& mesh) {
  constexpr float kEdges = 256.0F;
  const Vec3 size = mesh.bounds.size();
  const float longest = std::max({size.x, size.y, size.z});
  return longest > 0.0F ? longest / kEdges : 1.0F;
}

DisplacedNormals normals_of(MeshNormals asked) {
  if (asked == MeshNormals::flat) return DisplacedNormals::flat;
  return asked == MeshNormals::smooth ? DisplacedNormals::smooth : DisplacedNormals::creased;
}

Result<std::shared_ptr<const TriangleMesh>> make_displaced(const ObjectDesc& object,
                                                           const DisplacementSetting& setting,
                                                           bool on_uv) {
  const DisplacementDesc& desc = *object.displacement;
  const auto asked = mesh_use_of(object, {});
  if (!asked) return asked.error();
  SceneCache& cache = setting.looks.cache();
  const auto base = is_file_sequence(object.mesh)
                        ? cache.frame_mesh(frame_file_at(object.mesh, setting.looks.time()),
                                           base_use_of(object, setting.extras))
                        : cache.mesh(object.mesh, base_use_of(object, setting.extras));
  if (!base) return base.error();
  if (on_uv && (*base)->uvs.empty()) {
    return Error{"displacement: its texture is mapped by uv, of which the mesh '" + object.mesh +
                 "' has none; expected a mapping by object or world"};
  }
  for (const TextureDesc* read : textures_read(setting.looks.job(), desc.texture)) {
    if (!looks_at_vertices(*read)) continue;
    return Error{"displacement: its texture '" + read->name +
                 "' looks at colours or second coordinates of vertices; expected one that is "
                 "mapped by uv, object or world"};
  }
  const auto texture = setting.looks.texture(desc.texture);
  if (!texture) return texture.error().in("displacement");
  const float height = desc.height.at(setting.looks.time());
  const float midlevel = desc.midlevel.at(setting.looks.time());
  const HeightField field = [&](const Vec2& uv, const Vec3& position) {
    TexturePoint at;
    at.uv = uv;
    at.object = position;
    at.world = Vec3(setting.to_world * Vec4(position, 1.0F));
    return height * ((*texture)->scalar(at) - midlevel);
  };
  Displacement how;
  how.max_edge = desc.max_edge > 0.0F ? desc.max_edge : default_edge(**base);
  how.budget = desc.budget;
  how.normals = normals_of(asked->normals);
  auto made = displace(**base, how, field);
  if (!made) return made.error().in("displacement");
  if (setting.extras.tangents) compute_tangents(**made);
  return std::shared_ptr<const TriangleMesh>(*made);
}

/// Whether `path`, a curve's, lies within `texture`. Textures written in place are named by their
/// path in parentheses.
bool is_within(std::string_view path, const std::string& texture) {
  const std::string prefix = texture.starts_with('(') ? texture.substr(1, texture.size() - 2) + "."
                                                      : "textures." + texture + ".";
  return path.starts_with(prefix);
}

}  // namespace

bool may_be_displaced(const ObjectDesc& object) {
  if (!object.displacement) return false;
  const Animated<float>& height = object.displacement->height;
  return !height.is_constant() || height.constant != 0.0F;
}

bool is_displaced(const ObjectDesc& object, const JobTime& time) {
  return object.displacement && object.displacement->height.at(time) != 0.0F;
}

bool displacement_changes(const Job& job, const ObjectDesc& object) {
  if (!object.displacement) return false;
  if (!object.displacement->height.is_constant() || !object.displacement->midlevel.is_constant())
    return true;
  const auto textures = textures_read(job, object.displacement->texture);
  return std::any_of(job.curves.begin(), job.curves.end(), [&](const Curve& curve) {
    if (std::visit([](const auto& value) { return value.is_constant(); }, curve.value))
      return false;
    return std::any_of(textures.begin(), textures.end(), [&](const TextureDesc* texture) {
      return is_within(curve.path, texture->name);
    });
  });
}

Result<std::shared_ptr<const TriangleMesh>> displaced_mesh(const ObjectDesc& object,
                                                           const DisplacementSetting& setting) {
  const auto textures = textures_read(setting.looks.job(), object.displacement->texture);
  const bool on_uv = std::any_of(textures.begin(), textures.end(),
                                 [](const TextureDesc* texture) { return looks_at_uv(*texture); });
  return setting.looks.cache().displaced(key_of(object, setting, textures),
                                         [&] { return make_displaced(object, setting, on_uv); });
}

}  // namespace hyades::core
