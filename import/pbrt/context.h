#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/job/yaml_build.h"
#include "import/names.h"
#include "import/pbrt/scene.h"
#include "import/pbrt/spectra.h"
#include "import/scene_source.h"
#include "import/tinted.h"

namespace hyades::core::pbrt {

/// A scene with the files that must be read to say it.
struct LoadedScene {
  ParsedScene scene;
  std::map<std::string, Spectrum> spectra;     ///< of .spd files, by their names
  std::map<std::string, Bytes> files;          ///< what made files are made from
  std::map<std::string, std::string> missing;  ///< why a file is not in `files`
};

/// What is shared while a scene is put into the job language.
struct Context {
  Context(const LoadedScene& scene, const SceneRequest& request);

  const LoadedScene& loaded;
  const ParsedScene& scene;
  const SceneRequest& request;
  Report report;

  /// From the file's world to the job's: the identity, or what mirrors x. See docs/import.md.
  Mat4d to_job{1.0};
  /// What the film multiplies all light by (its sensor's exposure); lights take it over.
  float exposure = 1.0F;

  /// Pictures of goniometric lights that are made: by file and turn, the light that is the first to
  /// have each, and the mean of its pixels.
  struct LightPicture {
    size_t light = 0;
    double mean = 0.0;
  };
  std::map<std::string, LightPicture> light_pictures;

  /// Counts vertices or triangles of meshes that are made. False, after one error, where they are
  /// too many for what the scene's files hold.
  bool may_make(uint64_t elements, const Place& place);

  Names texture_names, material_names, medium_names, light_names;
  YamlMap textures, materials, media, lights;

  /// "beside" put before the reference of a file that the scene names; its path is checked. Empty,
  /// and an error of the report, where it is none or there is no such file.
  std::string beside(const std::string& reference, const Place& place);
  std::vector<std::string> files;  ///< SceneSections::files

 private:
  uint64_t made_ = 0;
  uint64_t most_made_;
};

/// Textures or materials that are made of each other: as many in a row as jobs may have.
inline constexpr int kLongestChain = 32;

/// The parameters of one thing of the scene.
ParameterReader read(Context& context, const Entity& entity);

/// What a colour is for: another white counts.
enum class ColorUse { light, surface };

/// The colour that a parameter of type rgb, spectrum or blackbody says; spectra of light have
/// luminance 1. An error of the report, and nothing, where it says none.
std::optional<Rgb> color_of(Context& context, const Parameter& parameter, ColorUse use);

/// {matrix: ...} in a list, or simpler steps that do the same; null where nothing moves.
YamlPtr transform_node(const Mat4d& m);

}  // namespace hyades::core::pbrt
