#include "import/obj/read_obj_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/read_mesh.h"
#include "import/names.h"
#include "import/obj/mtl_material.h"
#include "import/within_folder.h"

namespace hyades::core {

namespace {

/// Of a mesh that says nothing of itself.
constexpr const char* kOnlyName = "mesh";

struct Part {
  std::string material;  ///< as the file names it
  Bounds bounds;
  bool colored = false;  ///< its vertices are
};

class ObjScene : public SceneSource {
 public:
  std::string file;   ///< without its folder
  std::string place;  ///< with it
  std::vector<Part> parts;
  std::map<std::string, MtlMaterial> materials;
  std::map<std::string, std::string>
      libraries;  ///< where a material is said, from the mesh's folder on
  std::vector<std::string> notes;

  Result<SceneSections> sections(const SceneRequest& request) const override {
    SceneSections told;
    told.notes = notes;
    for (const Part& part : parts) told.bounds.include(part.bounds);
    const Vec3 size = told.bounds.size();
    const float diagonal = std::sqrt(glm::dot(size, size));
    Names names(kOnlyName, request.prefix);
    YamlMap looks;
    YamlMap objects;
    for (const Part& part : parts) {
      const bool unnamed = parts.size() == 1 && part.material == kNoMaterial;
      const std::string name = names.add(unnamed ? kOnlyName : part.material);
      YamlMap object{{"mesh", yaml_text(request.beside + file)}};
      if (parts.size() > 1) object.put("part", yaml_text(part.material));
      const auto found = materials.find(part.material);
      const MtlMaterial plain;
      const MtlMaterial& material = found != materials.end() ? found->second : plain;
      const auto in_library = libraries.find(part.material);
      const std::string library =
          in_library != libraries.end() ? in_library->second : std::string();
      const MtlLook look =
          look_of(material, {diagonal, part.colored}, [&](const std::string& picture) {
            told.files.push_back(resolve_reference(picture, library));
            return request.beside + told.files.back();
          });
      for (const std::string& line : look.notes)
        told.notes.push_back(resolve_reference(library, place) + ": " + line);
      looks.put(name, look.material);
      object.put("material", yaml_text(name));
      if (!look.emit.empty()) object.put("emit", look.emit);
      objects.put(name, object);
    }
    told.sections = YamlMap{{"materials", looks.node()}, {"objects", objects.node()}}.node();
    return told;
  }

  Result<Bytes> made_file(const std::string& name) const override {
    return Error{place + ": '" + name + "' is not made of it"};
  }
};

/// All pictures of a material.
std::vector<const MtlMap*> maps_of(const MtlMaterial& m) {
  return {&m.diffuse_map, &m.specular_map, &m.emission_map,      &m.dissolve_map,
          &m.bump_map,    &m.normal_map,   &m.roughness_map,     &m.metallic_map,
          &m.sheen_map,   &m.coat_map,     &m.coat_roughness_map};
}

/// The libraries of one line: its names have blanks between them, and may have some within.
std::vector<std::string> libraries_of(AssetResolver& files, std::string line,
                                      const std::string& scene) {
  std::replace(line.begin(), line.end(), '\\', '/');
  if (files.exists(resolve_reference(line, scene))) return {line};
  constexpr std::string_view kEnd = ".mtl";
  std::vector<std::string> names;
  size_t begin = 0;
  for (size_t at = line.find(kEnd); at != std::string::npos; at = line.find(kEnd, at + 1)) {
    const size_t end = at + kEnd.size();
    if (end < line.size() && line[end] != ' ' && line[end] != '\t') continue;
    names.push_back(line.substr(begin, end - begin));
    begin = std::min(line.find_first_not_of(" \t", end), line.size());
  }
  if (begin < line.size()) names.push_back(line.substr(begin));
  return names;
}

/// The materials of one library.
Status read_library(AssetResolver& files, const std::string& name, ObjScene& scene) {
  const std::string place = resolve_reference(name, scene.place);
  if (auto inside = within_folder(name); !inside) return inside.error().in(scene.place);
  const auto bytes = files.open(name, scene.place);
  if (!bytes && files.exists(place)) return bytes.error().in(scene.place);
  if (!bytes) {
    scene.notes.push_back(scene.place + ": " + bytes.error().message + "; its materials are clay");
    return {};
  }
  auto materials = parse_mtl({bytes->chars(), bytes->size()});
  if (!materials) return materials.error().in(place);
  for (MtlMaterial& material : *materials) {
    for (const MtlMap* map : maps_of(material)) {
      if (!map->given()) continue;
      const auto inside = within_folder(resolve_reference(map->file, name));
      if (inside) continue;
      return inside.error().in(place + ": material '" + material.name + "'");
    }
    if (scene.materials.contains(material.name)) {
      scene.notes.push_back(place + ": line " + std::to_string(material.line) + ": material '" +
                            material.name + "' is there for the second time: the last one counts");
    }
    scene.libraries[material.name] = name;
    const std::string called = material.name;
    scene.materials[called] = std::move(material);
  }
  return {};
}

/// The libraries of all lines, each once: where it is named for the last time, as the last material
/// of a name counts.
std::vector<std::string> libraries_of(AssetResolver& files, const std::vector<std::string>& lines,
                                      const std::string& scene) {
  std::vector<std::string> names;
  for (const std::string& line : lines) {
    for (std::string& name : libraries_of(files, line, scene)) names.push_back(std::move(name));
  }
  std::set<std::string> known;
  std::vector<std::string> last;
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    if (known.insert(resolve_reference(*name, scene)).second) last.push_back(std::move(*name));
  }
  std::reverse(last.begin(), last.end());
  return last;
}

void note_what_is_left_out(const MeshParts& mesh, ObjScene& scene) {
  for (const Part& part : scene.parts) {
    // That a library is missing has been told, and a mesh may have none.
    if (scene.materials.empty() || part.material == kNoMaterial) continue;
    if (scene.materials.contains(part.material)) continue;
    scene.notes.push_back(scene.place + ": no library has a material '" + part.material +
                          "'; it is clay");
  }
  if (mesh.left_out > 0) {
    scene.notes.push_back(
        fmt::format("{}: {} points, lines, curves and faces of less than three "
                    "corners are left out",
                    scene.place, mesh.left_out));
  }
}

}  // namespace

Result<std::shared_ptr<const SceneSource>> read_obj_scene(AssetResolver& files,
                                                          const std::string& reference) {
  auto mesh = read_mesh_parts(files, reference);
  if (!mesh) return mesh.error();
  auto scene = std::make_shared<ObjScene>();
  scene->place = reference;
  scene->file = std::filesystem::path(reference).filename().string();
  Bounds bounds;
  for (const MeshPart& part : mesh->parts) {
    scene->parts.push_back({part.name, part.mesh->bounds, !part.mesh->colors.empty()});
    bounds.include(part.mesh->bounds);
  }
  if (bounds.empty()) return Error{reference + ": the mesh has no triangles"};
  for (const std::string& library : libraries_of(files, mesh->libraries, reference)) {
    if (auto read = read_library(files, library, *scene); !read) return read.error();
  }
  note_what_is_left_out(*mesh, *scene);
  return std::shared_ptr<const SceneSource>(std::move(scene));
}

}  // namespace hyades::core
