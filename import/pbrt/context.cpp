#include "import/pbrt/context.h"

#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "import/pbrt/transforms.h"
#include "import/within_folder.h"

namespace hyades::core::pbrt {

namespace {

/// Vertices or triangles of all meshes that are made of a scene, which takes up to 3 GB, and more
/// of long files: their curves and patches become up to 16 for each byte, and so do triangles that
/// are subdivided four times. A short line may ask for millions.
constexpr uint64_t kMostElements = uint64_t{1} << 24;
constexpr uint64_t kMostElementsPerByte = 16;

uint64_t bytes_of(const LoadedScene& loaded) {
  uint64_t bytes = loaded.scene.bytes;
  for (const auto& [name, file] : loaded.files) bytes += file.size();
  return bytes;
}

/// Whether a picture of the scene's camera, seen as right-handed axes have it, is the wrong way
/// round. A camera of perspective has x to the right, y up and z forward, which are left-handed;
/// a panorama's middle is -x and its right -z, which are right-handed.
bool needs_mirror(const ParsedScene& scene) {
  const bool turned = linear_determinant(scene.camera.to_world.at[0]) < 0.0;
  return (scene.camera.type == "spherical") == turned;
}

}  // namespace

Context::Context(const LoadedScene& from, const SceneRequest& asked)
    : loaded(from),
      scene(from.scene),
      request(asked),
      texture_names("texture", asked.prefix),
      material_names("material", asked.prefix),
      medium_names("medium", asked.prefix),
      light_names("light", asked.prefix),
      most_made_(kMostElements + kMostElementsPerByte * bytes_of(from)) {
  report.notes = scene.notes;
  if (needs_mirror(scene)) to_job = scaling(Vec3d(-1.0, 1.0, 1.0));
}

bool Context::may_make(uint64_t elements, const Place& place) {
  if (made_ > most_made_) return false;
  made_ += elements;
  if (made_ <= most_made_) return true;
  report.error(place, "the meshes that are made of the scene up to here have more than " +
                          format_count(most_made_) +
                          " triangles or vertices, which is too much for what its files hold");
  return false;
}

std::string Context::beside(const std::string& reference, const Place& place) {
  auto path = within_folder(reference);
  if (!path) {
    report.error(place, path.error().message);
    return {};
  }
  if (const auto why = loaded.missing.find(reference); why != loaded.missing.end()) {
    report.error(place, why->second);
    return {};
  }
  files.push_back(*path);
  return request.beside + *path;
}

ParameterReader read(Context& context, const Entity& entity) {
  return {entity.parameters, entity.place, context.report};
}

std::optional<Rgb> color_of(Context& context, const Parameter& p, ColorUse use) {
  const auto wrong = [&](const std::string& what) {
    context.report.error(p.place, "parameter '" + p.name + "': " + what);
    return std::optional<Rgb>();
  };
  if (p.type == "rgb") {
    if (p.numbers.size() != 3) return wrong("expected 3 numbers of an rgb");
    const Vec3d rgb(p.numbers[0], p.numbers[1], p.numbers[2]);
    if (rgb.x < 0.0 || rgb.y < 0.0 || rgb.z < 0.0) return wrong("found a colour below 0");
    return use == ColorUse::light ? light_from_rgb(*p.space, rgb) : surface_from_rgb(*p.space, rgb);
  }
  if (p.type == "blackbody") {
    if (p.numbers.size() != 1) return wrong("expected one temperature in kelvin");
    if (use != ColorUse::light) return wrong("a black body is only a colour of light");
    return blackbody_light(static_cast<double>(p.numbers[0]));
  }
  if (p.type != "spectrum") return wrong("type '" + p.type + "' says no colour");
  Spectrum from_file;
  if (!p.texts.empty()) {
    const std::string& name = p.texts[0];
    if (const auto light = named_light(name)) {
      return use == ColorUse::light ? *light : Rgb(1.0F);
    }
    if (const auto glass = named_glass(name)) return Rgb(*glass);
    if (const auto metal = named_metal(name)) return metal->is_k ? Rgb(0.0F) : metal->eta;
    const auto found = context.loaded.spectra.find(name);
    if (found == context.loaded.spectra.end()) return wrong("there is no spectrum '" + name + "'");
    from_file = found->second;
  } else {
    auto spectrum = spectrum_of_pairs(p.numbers);
    if (!spectrum) return wrong(spectrum.error().message);
    from_file = std::move(*spectrum);
  }
  return use == ColorUse::light ? light_color(from_file) : surface_color(from_file);
}

YamlPtr transform_node(const Mat4d& m) {
  if (m == Mat4d(1.0)) return nullptr;
  bool diagonal = true;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) diagonal &= c == r || m[c][r] == 0.0;
  }
  std::vector<YamlPtr> steps;
  if (diagonal) {
    const Vec3 scale{Vec3d(m[0][0], m[1][1], m[2][2])};
    const Vec3 by{Vec3d(m[3])};
    if (scale != Vec3(1.0F)) steps.push_back(YamlMap{{"scale", color_node(scale)}}.node());
    if (by != Vec3(0.0F)) steps.push_back(YamlMap{{"translate", yaml_vector(by)}}.node());
    if (steps.empty()) return nullptr;
    return yaml_list(std::move(steps));
  }
  std::vector<float> rows;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) rows.push_back(static_cast<float>(m[c][r]));
  }
  rows.insert(rows.end(), {0.0F, 0.0F, 0.0F, 1.0F});
  return yaml_list({YamlMap{{"matrix", yaml_numbers(rows)}}.node()});
}

}  // namespace hyades::core::pbrt
