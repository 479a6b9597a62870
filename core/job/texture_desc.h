#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/job/inputs.h"
#include "core/job/source.h"
#include "core/job/transform_desc.h"

namespace hyades::core {

/// image: the file and how it is read.
struct TextureImage {
  std::string file;                  ///< with <UDIM> in its name: one file per unit of uv
  std::string color_space = "auto";  ///< auto | srgb | linear
  std::string wrap = "repeat";       ///< along u: repeat | clamp | mirror | black
  std::string wrap_v = "repeat";     ///< along v
  std::string filter = "trilinear";  ///< trilinear | anisotropic | bilinear | nearest
};

/// From places to the coordinates that images and patterns read.
struct TextureMapping {
  /// default | uv | uv1 | object | world | planar | spherical | cylindrical | triplanar
  std::string type = "default";
  std::string space = "object";  ///< object | world: of the last four
  TransformList transform;       ///< of the place, before it is mapped
  Animated<float> blend{0.3F};   ///< triplanar: how softly the planes go over into each other, 0..1
  Animated<Vec3> scale{Vec3(1.0F)};  ///< cells (or repeats of the image) per unit of the mapping
  Animated<Vec3> offset{Vec3(0.0F)};
};

/// Patterns of Perlin noise.
struct TextureNoise {
  int octaves = 1;
  Animated<float> lacunarity{2.0F};
  Animated<float> gain{0.5F};
  std::optional<Animated<float>>
      time;                          ///< the fourth coordinate; absent: noise in three dimensions
  Animated<float> distortion{0.0F};  ///< marble, wood: how far noise moves the layers
};

/// cellular
struct TextureCells {
  std::string metric = "euclidean";  ///< euclidean | manhattan | chebyshev
  std::string feature = "f1";        ///< f1 | f2 | edges | id
  Animated<float> jitter{1.0F};      ///< 0..1
};

/// brick, stripes, grid
struct TextureLines {
  Animated<float> width{0.1F};     ///< of the lines or the mortar, part of a cell
  Animated<float> shift{0.5F};     ///< brick: of every other row
  Animated<float> softness{0.0F};  ///< part of the way from a line's edge to the cell's middle
};

/// remap
struct TextureRemap {
  Animated<float> low{0.0F}, high{1.0F};
  Animated<float> to_low{0.0F}, to_high{1.0F};
  std::string ends = "clamp";  ///< clamp | smooth | open
};

/// ramp
struct TextureStop {
  float at = 0.0F;
  ColorInput color;
};

struct TextureDesc {
  std::string name;
  SourceLocation where;
  std::string type;  ///< a name of texture_types()
  ColorInput a{};    ///< patterns and nodes: first colour or input; constant: its value
  ColorInput b{};    ///< patterns and nodes: second colour; scale: factor
  ScalarInput amount{Animated<float>(0.5F), {}};  ///< mix: share of b; ramp: its input
  TextureImage image;
  TextureMapping mapping;
  TextureNoise noise;
  TextureCells cells;
  TextureLines lines;
  std::string shape = "linear";  ///< gradient: linear | radial | cylindrical | spherical | angular
  TextureRemap remap;
  std::vector<TextureStop> stops;    ///< ramp
  std::string between = "linear";    ///< ramp: linear | smooth | steps
  Animated<float> exponent{1.0F};    ///< power
  Animated<float> level{0.5F};       ///< threshold
  Animated<float> softness{0.0F};    ///< threshold: width of the step
  Animated<float> hue{0.0F};         ///< hue-saturation: turn, degrees
  Animated<float> saturation{1.0F};  ///< hue-saturation: factor
  Animated<float> value{1.0F};       ///< hue-saturation: factor
  std::string channel =
      "color";  ///< image, vertex-color, channel: red | green | blue | alpha | luminance
};

/// The names of the textures that `texture` is made of, "" among them.
std::vector<std::string> textures_used(const TextureDesc& texture);

}  // namespace hyades::core
