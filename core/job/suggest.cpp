#include "core/job/suggest.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/text.h"

namespace hyades::core {
namespace {

/// A word of other renderers, and what it is called where that name is among those expected.
struct OtherWord {
  std::string_view word;
  std::string_view name;
  std::string_view instead = "";  ///< what is said where the name does not mean the same
};

constexpr auto kOtherWords = std::to_array<OtherWord>({
    // materials
    {"metal", "conductor"},
    {"glass", "dielectric"},
    {"diffuse", "lambert"},
    {"matte", "lambert"},
    {"plastic", "glossy"},
    {"disney", "principled"},
    {"pbr", "principled"},
    {"translucent", "diffuse-transmission"},
    {"clearcoat", "coat"},
    {"velvet", "sheen"},
    {"fur", "hair"},
    {"blend", "mix"},
    {"emission", "lambert", "; what an object gives off is its 'emit'"},
    {"emissive", "lambert", "; what an object gives off is its 'emit'"},
    {"light", "lambert", "; what an object gives off is its 'emit'"},
    {"transparent", "lambert", "; what lets light straight through is 'opacity' of any material"},
    // shapes
    {"cube", "box"},
    {"plane", "rectangle"},
    {"quad", "rectangle"},
    {"rect", "rectangle"},
    {"ball", "sphere"},
    {"circle", "disk"},
    {"mesh", "sphere", "; a mesh is told by its file: 'mesh: body.ply'"},
    // lights
    {"area", "point",
     "; a lamp with an area is an object with 'emit' (a rectangle shines upwards until it is "
     "turned)"},
    {"directional", "sun"},
    {"distant", "sun"},
    {"omni", "point"},
    {"projection", "projector"},
    {"sky", "point", "; light from all around is the job's 'environment'"},
    {"infinite", "point", "; light from all around is the job's 'environment'"},
    {"environment", "point", "; light from all around is the job's 'environment'"},
    {"dome", "point", "; light from all around is the job's 'environment'"},
    // textures
    {"bitmap", "image"},
    {"imagemap", "image"},
    {"checkerboard", "checker"},
    {"voronoi", "cellular"},
    {"worley", "cellular"},
    {"noise", "fbm3d"},
    {"multiply", "scale"},
    {"clamp", "remap"},
    // layers
    {"Z", "depth"},
    {"z", "depth"},
    {"rgb", "beauty"},
    {"combined", "beauty"},
    {"normals", "normal"},
    {"cryptomatte", "crypto_object"},
    {"id", "object_id"},
    {"vector", "motion"},
    // keys
    {"samples", "sampling", ", did you mean 'sampling: {samples: N}'?"},
    {"spp", "sampling", ", did you mean 'sampling: {samples: N}'?"},
    {"spp", "samples"},
    {"resolution", "film", ", did you mean 'film: {size: [WIDTH, HEIGHT]}'?"},
    {"resolution", "size"},
    {"size", "film", ", did you mean 'film: {size: [WIDTH, HEIGHT]}'?"},
    {"samples", "size", "; how many is told by 'sampling: {samples: N}' of the job"},
    {"seed", "sampling", ", did you mean 'sampling: {seed: N}'?"},
    {"fov", "camera", ", did you mean 'camera: {fov: N}'?"},
    {"look_at", "camera", ", did you mean 'camera: {look_at: [X, Y, Z]}'?"},
    {"scale", "transform", ", did you mean 'transform: [{scale: 2}]'?"},
    {"direction", "target"},
    {"direction", "look_at"},
    {"elevation", "direction", "; the sun of a clear sky is the 'sky' of the job's 'environment'"},
    {"power", "irradiance"},
    {"world", "environment"},
    {"background", "environment"},
    {"sky", "environment"},
    {"shapes", "objects"},
    {"meshes", "objects"},
    {"animation", "frames"},
    {"output", "outputs"},
    {"position", "at"},
    {"location", "at"},
    {"translate", "at"},
    {"origin", "look_from"},
    {"position", "look_from"},
    {"target", "look_at"},
    {"emission", "emit"},
    {"albedo", "color"},
    {"diffuse", "base_color"},
    {"diffuse", "color"},
    {"texture", "image"},
    {"texture", "color", ", did you mean 'color: NAME' of a texture?"},
    {"texture", "base_color", ", did you mean 'base_color: NAME' of a texture?"},
    {"color", "material", "; the colour of an object is its material's"},
    {"colour", "material", "; the colour of an object is its material's"},
    {"transparency", "opacity", ", did you mean 'opacity', which is 1 minus that?"},
    {"rotate", "transform", ", did you mean 'transform: [{rotate_y: 30}]'?"},
    {"rotation", "transform", ", did you mean 'transform: [{rotate_y: 30}]'?"},
    {"metal", "metallic"},
    {"metalness", "metallic"},
    {"r", "radius"},
    {"focal_length", "fov"},
    {"hdri", "image"},
    {"hdr", "image"},
    {"file", "image"},
    {"filename", "image"},
    {"filename", "file"},
    {"image", "file"},
    {"path", "image"},
    {"integrator", "samples", "; it is the job's own: 'integrator: path' beside 'sampling'"},
    {"strength", "irradiance"},
    {"strength", "power"},
    {"max_depth", "integrator", "; how deep paths go is the integrator's 'max_depth'"},
    {"bounces", "integrator", ", did you mean 'integrator: {max_depth: N}'?"},
    {"bounces", "max_depth"},
    {"bounces", "samples", "; how deep paths go is the integrator's 'max_depth'"},
    {"max_bounces", "integrator", ", did you mean 'integrator: {max_depth: N}'?"},
    {"max_bounces", "max_depth"},
    {"rotation", "rotate_y"},
    {"diameter", "radius", ", did you mean 'radius', half of that?"},
    {"a", "first"},
    {"b", "second"},
    {"factor", "amount"},
    {"fac", "amount"},
    {"color", "base_color"},
    {"color", "transmission"},
    {"fps", "frames", ", did you mean 'frames: {fps: 24}'?"},
    {"width", "film", ", did you mean 'film: {size: [WIDTH, HEIGHT]}'?"},
    {"height", "film", ", did you mean 'film: {size: [WIDTH, HEIGHT]}'?"},
    {"intensity", "power"},
    {"intensity", "radiance"},
    {"intensity", "irradiance"},
    {"intensity", "strength"},
});

/// Letters that tell a word by its beginning.
constexpr size_t kBeginning = 4;

bool is_among(std::string_view name, std::span<const std::string> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string meant(std::string_view name) { return ", did you mean '" + std::string(name) + "'?"; }

}  // namespace

std::string other_word(std::string_view word, std::span<const std::string> names) {
  for (const OtherWord& other : kOtherWords) {
    if (other.word != word || !is_among(other.name, names)) continue;
    return other.instead.empty() ? meant(other.name) : std::string(other.instead);
  }
  // "color" of "base_color", "rough" of "roughness".
  const std::string ending = "_" + std::string(word);
  const auto longer = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return name.ends_with(ending) || (word.size() >= kBeginning && name.starts_with(word));
  });
  return longer != names.end() ? meant(*longer) : "";
}

std::string suggest(std::string_view word, std::span<const std::string> names) {
  const std::string other = other_word(word, names);
  return other.empty() ? did_you_mean(word, names) : other;
}

}  // namespace hyades::core
