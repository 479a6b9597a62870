#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/job/fields.h"
#include "core/job/inputs.h"
#include "core/job/kinds_of.h"
#include "core/job/source.h"

/// Textures: one struct per type, each with its keys. What makes a texture of them stands in
/// core/scene: texture_makers.cpp, pattern_makers.cpp and texture_node_makers.cpp.
namespace hyades::core {

struct TextureTraits {
  const char* type = "";  ///< its name in jobs
  bool on_uv = false;     ///< of those with a mapping: it is uv where the job says none, not object
};

/// A type's name as an argument of templates.
template <size_t kSize>
struct TypeName {
  char text[kSize] = {};
  constexpr TypeName(const char (&name)[kSize]) { std::copy_n(name, kSize, text); }  // NOLINT
};

namespace textures {

/// A type that has no more keys than others of its family.
template <TypeName kName, class Family, bool kOnUv = false>
struct Named : Family {
  static constexpr TextureTraits kTraits{kName.text, kOnUv};
};

inline const std::array<std::string, 3> kColorSpaces = {"auto", "srgb", "linear"};
inline const std::array<std::string, 4> kWraps = {"repeat", "clamp", "mirror", "black"};
inline const std::array<std::string, 4> kFilters = {"trilinear", "anisotropic", "bilinear",
                                                    "nearest"};
inline const std::array<std::string, 6> kChannels = {"color", "red",   "green",
                                                     "blue",  "alpha", "luminance"};
inline const std::array<std::string, 9> kMappings = {
    "default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"};
inline const std::array<std::string, 2> kMappingSpaces = {"object", "world"};
inline const std::array<std::string, 3> kMetrics = {"euclidean", "manhattan", "chebyshev"};
inline const std::array<std::string, 4> kFeatures = {"f1", "f2", "edges", "id"};
inline const std::array<std::string, 5> kGradientShapes = {"linear", "radial", "cylindrical",
                                                           "spherical", "angular"};
inline const std::array<std::string, 3> kRemapEnds = {"clamp", "smooth", "open"};
inline const std::array<std::string, 3> kRampShapes = {"linear", "smooth", "steps"};

/// From places to the coordinates that images and patterns read.
struct Mapping {
  std::string type = kMappings[0];
  std::string space = kMappingSpaces[0];  ///< of planar, spherical, cylindrical and triplanar
  TransformList transform;                ///< of the place, before it is mapped
  Animated<float> blend{0.3F};  ///< triplanar: how softly the planes go over into each other

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.choice("type", self.type, kMappings);
    visit.choice("space", self.space, kMappingSpaces);
    visit.transform("transform", self.transform);
    visit.animated("blend", self.blend, kUnitInterval);
  }
};

/// What lies somewhere.
struct Mapped {
  Mapping mapping;
  Animated<Vec3> scale{Vec3(1.0F)};  ///< cells (or repeats of the image) per unit of the mapping
  Animated<Vec3> offset{Vec3(0.0F)};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.type_or_map("mapping", "textures.mapping", self.mapping, kMappings);
    visit.animated_scale(KeyName{"scale", "mapping.scale"}, self.scale, kAnyNumber);
    visit.animated_scale(KeyName{"offset", "mapping.offset"}, self.offset, kAnyNumber);
  }
};

struct Constant {
  static constexpr TextureTraits kTraits{"constant"};
  ColorInput value;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("value", "a colour");
    visit.color_input(KeyName{"value", "a"}, self.value, kNotNegative);
  }
};

struct Image : Mapped {
  static constexpr TextureTraits kTraits{"image", true};
  std::string file;  ///< with <UDIM> in its name: one file per unit of uv
  std::string color_space = kColorSpaces[0];
  std::string wrap = kWraps[0];    ///< along u
  std::string wrap_v = kWraps[0];  ///< along v
  std::string filter = kFilters[0];
  std::string channel = kChannels[0];

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("file", "an image file");
    visit.file(KeyName{"file", "image.file"}, self.file);
    visit.choice(KeyName{"color_space", "image.color_space"}, self.color_space, kColorSpaces);
    visit.choices(KeyName{"wrap", "image.wrap"}, self.wrap, "image.wrap_v", self.wrap_v, kWraps);
    visit.choice(KeyName{"filter", "image.filter"}, self.filter, kFilters);
    visit.choice("channel", self.channel, kChannels);
    Mapped::fields(self, visit);
  }
};

/// The colours of a mesh's vertices.
struct VertexColor {
  static constexpr TextureTraits kTraits{"vertex-color"};
  std::string channel = kChannels[0];

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.choice("channel", self.channel, kChannels);
  }
};

// Patterns between two colours.

struct Pattern : Mapped {
  ColorInput a{Animated<Rgb>(Rgb(0.0F)), {}};
  ColorInput b{Animated<Rgb>(Rgb(1.0F)), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("a", self.a, kNotNegative);
    visit.color_input("b", self.b, kNotNegative);
    Mapped::fields(self, visit);
  }
};

using Checker = Named<"checker", Pattern, true>;

struct Brick : Pattern {
  static constexpr TextureTraits kTraits{"brick", true};
  Animated<float> mortar{0.1F};    ///< part of a cell
  Animated<float> shift{0.5F};     ///< of every other row
  Animated<float> softness{0.0F};  ///< part of the way from the mortar to the cell's middle

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Pattern::fields(self, visit);
    visit.animated(KeyName{"mortar", "width"}, self.mortar, kUnitInterval);
    visit.animated("shift", self.shift, kUnitInterval);
    visit.animated(KeyName{"softness", "line_softness"}, self.softness, kUnitInterval);
  }
};

struct Lines : Pattern {
  Animated<float> width{0.1F};     ///< part of a cell
  Animated<float> softness{0.0F};  ///< part of the way from a line's edge to the cell's middle

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Pattern::fields(self, visit);
    visit.animated("width", self.width, kUnitInterval);
    visit.animated(KeyName{"softness", "line_softness"}, self.softness, kUnitInterval);
  }
};

using Stripes = Named<"stripes", Lines, true>;
using Grid = Named<"grid", Lines, true>;

struct Gradient : Pattern {
  static constexpr TextureTraits kTraits{"gradient", true};
  std::string shape = kGradientShapes[0];

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Pattern::fields(self, visit);
    visit.choice("shape", self.shape, kGradientShapes);
  }
};

/// Perlin noise, of several sizes.
template <int kOctaves>
struct Noise : Pattern {
  int octaves = kOctaves;
  Animated<float> lacunarity{2.0F};
  Animated<float> gain{0.5F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Pattern::fields(self, visit);
    visit.integer(KeyName{"octaves", "noise.octaves"}, self.octaves, 1, 16);
    visit.animated(KeyName{"lacunarity", "noise.lacunarity"}, self.lacunarity, {1.0, 16.0});
    visit.animated(KeyName{"gain", "noise.gain"}, self.gain, {0.0, 4.0});
  }
};

/// `Time` is a number, the fourth coordinate, or may be nothing: then there are three.
template <int kOctaves, class Time>
struct NoiseInTime : Noise<kOctaves> {
  Time time{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Noise<kOctaves>::fields(self, visit);
    visit.animated(KeyName{"time", "noise.time"}, self.time, kAnyNumber);
  }
};
using Fractal = NoiseInTime<4, std::optional<Animated<float>>>;

struct Layers : Fractal {
  Animated<float> distortion{1.0F};  ///< how far noise moves the layers

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Fractal::fields(self, visit);
    visit.animated(KeyName{"distortion", "noise.distortion"}, self.distortion, kAnyNumber);
  }
};

using Perlin3d = Named<"perlin3d", Noise<1>>;
using Perlin4d = Named<"perlin4d", NoiseInTime<1, Animated<float>>>;
using Fbm3d = Named<"fbm3d", Noise<4>>;
using Fbm4d = Named<"fbm4d", NoiseInTime<4, Animated<float>>>;
using Turbulence = Named<"turbulence", Fractal>;
using Ridged = Named<"ridged", Fractal>;
using Marble = Named<"marble", Layers>;
using Wood = Named<"wood", Layers>;

struct Cellular : Pattern {
  static constexpr TextureTraits kTraits{"cellular"};
  std::optional<Animated<float>> time;  ///< the fourth coordinate; absent: there are three
  std::string metric = kMetrics[0];
  std::string feature = kFeatures[0];
  Animated<float> jitter{1.0F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    Pattern::fields(self, visit);
    visit.animated(KeyName{"time", "noise.time"}, self.time, kAnyNumber);
    visit.choice("metric", self.metric, kMetrics);
    visit.choice("feature", self.feature, kFeatures);
    visit.animated("jitter", self.jitter, kUnitInterval);
  }
};

// What becomes of other textures.

struct OfInput {
  ColorInput input;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("input", "a colour or texture");
    visit.color_input(KeyName{"input", "a"}, self.input, kNotNegative);
  }
};

struct Scale : OfInput {
  static constexpr TextureTraits kTraits{"scale"};
  ColorInput factor;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.color_input(KeyName{"factor", "b"}, self.factor, kNotNegative);
  }
};

struct OfTwo {
  ColorInput a;
  ColorInput b;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("a", "a colour or texture");
    visit.require("b", "a colour or texture");
    visit.color_input("a", self.a, kNotNegative);
    visit.color_input("b", self.b, kNotNegative);
  }
};

using Add = Named<"add", OfTwo>;
using Divide = Named<"divide", OfTwo>;
using Min = Named<"min", OfTwo>;
using Max = Named<"max", OfTwo>;

struct Mix : OfTwo {
  static constexpr TextureTraits kTraits{"mix"};
  ScalarInput amount{Animated<float>(0.5F), {}};  ///< share of b

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfTwo::fields(self, visit);
    visit.scalar_input("amount", self.amount, kUnitInterval);
  }
};

using Invert = Named<"invert", OfInput>;

struct Remap : OfInput {
  static constexpr TextureTraits kTraits{"remap"};
  Animated<float> low{0.0F}, high{1.0F};
  Animated<float> to_low{0.0F}, to_high{1.0F};
  std::string ends = kRemapEnds[0];

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.animated(KeyName{"low", "remap.low"}, self.low, kAnyNumber);
    visit.animated(KeyName{"high", "remap.high"}, self.high, kAnyNumber);
    visit.animated(KeyName{"to_low", "remap.to_low"}, self.to_low, kAnyNumber);
    visit.animated(KeyName{"to_high", "remap.to_high"}, self.to_high, kAnyNumber);
    visit.choice(KeyName{"ends", "remap.ends"}, self.ends, kRemapEnds);
  }
};

struct Power : OfInput {
  static constexpr TextureTraits kTraits{"power"};
  Animated<float> exponent{1.0F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.require("exponent", "a number");
    visit.animated("exponent", self.exponent, kNotNegative);
  }
};

struct Threshold : OfInput {
  static constexpr TextureTraits kTraits{"threshold"};
  Animated<float> level{0.5F};
  Animated<float> softness{0.0F};  ///< width of the step

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.animated("level", self.level, kAnyNumber);
    visit.animated("softness", self.softness, kNotNegative);
  }
};

struct Stop {
  float at = 0.0F;
  ColorInput color;
};

struct Ramp {
  static constexpr TextureTraits kTraits{"ramp"};
  ScalarInput input;
  std::vector<Stop> stops;
  std::string between = kRampShapes[0];

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("input", "a number or texture");
    visit.scalar_input(KeyName{"input", "amount"}, self.input, kAnyNumber);
    visit.require("stops", "a map of numbers to colours");
    visit.stops("stops", self.stops);
    visit.choice("between", self.between, kRampShapes);
  }
};

struct HueSaturation : OfInput {
  static constexpr TextureTraits kTraits{"hue-saturation"};
  Animated<float> hue{0.0F};  ///< added
  Animated<float> saturation{1.0F};
  Animated<float> value{1.0F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.animated("hue", self.hue, kAnyNumber.in("degrees"));
    visit.animated("saturation", self.saturation, kNotNegative);
    visit.animated("value", self.value, kNotNegative);
  }
};

struct ChannelOf : OfInput {
  static constexpr TextureTraits kTraits{"channel"};
  std::string channel;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    OfInput::fields(self, visit);
    visit.require("channel", "one of red, green, blue, alpha, luminance");
    visit.choice("channel", self.channel, std::span(kChannels).subspan(1));
  }
};

}  // namespace textures

using TextureKind = std::variant<
    textures::Constant, textures::Image, textures::VertexColor, textures::Checker, textures::Brick,
    textures::Stripes, textures::Grid, textures::Gradient, textures::Perlin3d, textures::Perlin4d,
    textures::Fbm3d, textures::Fbm4d, textures::Turbulence, textures::Ridged, textures::Marble,
    textures::Wood, textures::Cellular, textures::Scale, textures::Add, textures::Divide,
    textures::Min, textures::Max, textures::Mix, textures::Invert, textures::Remap, textures::Power,
    textures::Threshold, textures::Ramp, textures::HueSaturation, textures::ChannelOf>;

struct TextureDesc {
  std::string name;
  SourceLocation where;
  TextureKind kind;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    std::visit([&](auto& kind) { kind.fields(kind, visit); }, self.kind);
  }
};

/// The mapping of a texture; one that says nothing where it has none.
inline textures::Mapping mapping_of(const TextureDesc& texture) {
  return std::visit(
      [](const auto& kind) -> textures::Mapping {
        if constexpr (requires { kind.mapping; }) return kind.mapping;
        return {};
      },
      texture.kind);
}

}  // namespace hyades::core
