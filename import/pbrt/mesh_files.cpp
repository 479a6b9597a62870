#include "import/pbrt/mesh_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/geometry/read_hair.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/write_ply.h"
#include "import/pbrt/made_meshes.h"
#include "import/pbrt/meshes.h"

namespace hyades::core::pbrt {
namespace {

constexpr size_t kManyShapes = 256;      ///< scenes of fewer keep each as it is
constexpr size_t kSmallMesh = 3 * 4096;  ///< numbers of positions

/// Whether a shape may be joined with others like it.
bool is_small(const ShapeEntity& shape) {
  if (shape.type != "curve" && shape.type != "trianglemesh" && shape.type != "bilinearmesh") {
    return false;
  }
  if (shape.area_light >= 0 || shape.to_world.moves()) return false;
  return std::all_of(shape.parameters.begin(), shape.parameters.end(), [](const ParameterPtr& p) {
    return p->name != "alpha" && (p->name != "P" || p->numbers.size() <= kSmallMesh);
  });
}

bool are_alike(const ShapeEntity& a, const ShapeEntity& b) {
  return a.type == b.type && a.to_world.at[0] == b.to_world.at[0] && a.material == b.material &&
         a.material_name == b.material_name && a.reversed == b.reversed && a.inside == b.inside &&
         a.outside == b.outside && is_strand(a) == is_strand(b);
}

/// Adds the triangles of `part`; what only one of them has is filled up with zeros.
Status append(TriangleMesh& mesh, const TriangleMesh& part) {
  const size_t first = mesh.positions.size();
  const size_t all = first + part.positions.size();
  if (all > static_cast<size_t>(std::numeric_limits<int32_t>::max())) {
    return Error{"the meshes have too many vertices together"};
  }
  const bool normals = !mesh.normals.empty() || !part.normals.empty();
  const bool uvs = !mesh.uvs.empty() || !part.uvs.empty();
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  const auto fill = [&](auto& list, const auto& more) {
    list.resize(first);
    list.insert(list.end(), more.begin(), more.end());
    list.resize(all);
  };
  if (normals) fill(mesh.normals, part.normals);
  if (uvs) fill(mesh.uvs, part.uvs);
  for (std::array<uint32_t, 3> t : part.triangles) {
    for (uint32_t& corner : t) corner += static_cast<uint32_t>(first);
    mesh.triangles.push_back(t);
  }
  return {};
}

/// One file under a name that does not matter.
class OneFile : public AssetResolver {
 public:
  explicit OneFile(Bytes bytes) : bytes_(std::move(bytes)) {}
  Result<Bytes> open(const std::string&, const std::string&) override { return bytes_; }

 private:
  Bytes bytes_;
};

/// A number at the beginning of `text`, which is then what follows it.
std::optional<size_t> take_number(std::string_view& text) {
  size_t value = 0;
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (wrong != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return value;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// Shapes from `first` to `last` of a list.
struct Run {
  const std::vector<ShapeEntity>* shapes = nullptr;
  size_t first = 0;
  size_t last = 0;
  bool strands = false;  ///< a file of strands is meant
};

Result<Bytes> make_strands(const Run& run) {
  Report report;
  StrandList strands;
  for (size_t i = run.first; i <= run.last; ++i) {
    const ShapeEntity& shape = (*run.shapes)[i];
    if (!is_strand(shape)) return shape.place.error("it is no curve");
    if (Status s = append_strand(shape, report, strands); !s) return s.error();
  }
  return hair_bytes(strands);
}

std::optional<Run> run_of(const ParsedScene& scene, std::string_view name) {
  Run run;
  if (take_word(name, "object-")) {
    const auto object = take_number(name);
    if (!object || *object >= scene.objects.size() || !take_word(name, "-")) return std::nullopt;
    run.shapes = &scene.objects[*object].shapes;
  } else if (take_word(name, "shape-")) {
    run.shapes = &scene.shapes;
  } else {
    return std::nullopt;
  }
  const auto first = take_number(name);
  if (!first) return std::nullopt;
  run.first = run.last = *first;
  if (take_word(name, "-to-")) {
    const auto last = take_number(name);
    if (!last) return std::nullopt;
    run.last = *last;
  }
  run.strands = name == ".hair";
  if ((name != ".ply" && !run.strands) || run.last < run.first || run.last >= run.shapes->size()) {
    return std::nullopt;
  }
  return run;
}

}  // namespace

size_t mesh_run(const std::vector<ShapeEntity>& shapes, size_t first) {
  if (shapes.size() < kManyShapes || !is_small(shapes[first])) return 1;
  size_t end = first + 1;
  while (end < shapes.size() && is_small(shapes[end]) && are_alike(shapes[first], shapes[end])) {
    ++end;
  }
  return end - first;
}

std::string mesh_run_name(size_t first, size_t run) {
  std::string name = std::to_string(first);
  if (run > 1) name += "-to-" + std::to_string(first + run - 1);
  return name;
}

Result<Bytes> make_mesh_file(const LoadedScene& loaded, const std::string& name) {
  const auto run = run_of(loaded.scene, name);
  if (!run) return Error{"the scene has no mesh '" + name + "'"};
  if (run->strands) return make_strands(*run);
  const ShapeEntity& shape = (*run->shapes)[run->first];
  Report report;
  if (shape.type == "plymesh") {
    ParameterReader reader(shape.parameters, shape.place, report);
    const std::string file = reader.text("filename");
    const auto bytes = loaded.files.find(file);
    if (bytes == loaded.files.end()) return shape.place.error("cannot open '" + file + "'");
    OneFile files(bytes->second);
    auto mesh = read_mesh(files, file);
    if (!mesh) return shape.place.error(mesh.error().message);
    reverse(**mesh);
    return ply_bytes(**mesh);
  }
  TriangleMesh whole;
  for (size_t i = run->first; i <= run->last; ++i) {
    const ShapeEntity& part = (*run->shapes)[i];
    if (!is_made_mesh(part)) return Error{"the scene has no mesh '" + name + "'"};
    auto mesh = mesh_of(part, report);
    if (!mesh) return mesh.error();
    if (run->first == run->last) return ply_bytes(*mesh);
    if (Status s = append(whole, *mesh); !s) return part.place.error(s.error().message);
  }
  return ply_bytes(whole);
}

}  // namespace hyades::core::pbrt
