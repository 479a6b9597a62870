#pragma once

#include <array>
#include <optional>

#include "core/scene/name_table.h"
#include "core/textures/make_texture.h"

/// What the names in textures stand for: those of core/job/texture_desc.h.
namespace hyades::core {

inline constexpr std::array<NameRow<ColorSpace>, 3> kColorSpaces = {{
    {"auto", ColorSpace::automatic},
    {"srgb", ColorSpace::srgb},
    {"linear", ColorSpace::linear},
}};

inline constexpr std::array<NameRow<WrapMode>, 4> kWraps = {{
    {"repeat", WrapMode::repeat},
    {"clamp", WrapMode::clamp},
    {"mirror", WrapMode::mirror},
    {"black", WrapMode::black},
}};

inline constexpr std::array<NameRow<TextureFilter>, 4> kFilters = {{
    {"trilinear", TextureFilter::trilinear},
    {"anisotropic", TextureFilter::anisotropic},
    {"bilinear", TextureFilter::bilinear},
    {"nearest", TextureFilter::nearest},
}};

/// Nothing: the colour itself.
inline constexpr std::array<NameRow<std::optional<Channel>>, 6> kChannels = {{
    {"color", std::nullopt},
    {"red", Channel::red},
    {"green", Channel::green},
    {"blue", Channel::blue},
    {"alpha", Channel::alpha},
    {"luminance", Channel::luminance},
}};

/// What a kind of mapping is made of.
struct MappingKind {
  std::optional<MappingSpace> space;  ///< none: as the job says, or as the texture prefers
  Projection projection = Projection::none;
  bool triplanar = false;
};

inline constexpr std::array<NameRow<MappingKind>, 9> kMappings = {{
    {"default", {std::nullopt, Projection::none, false}},
    {"uv", {MappingSpace::uv, Projection::none, false}},
    {"uv1", {MappingSpace::second_uv, Projection::none, false}},
    {"object", {MappingSpace::object, Projection::none, false}},
    {"world", {MappingSpace::world, Projection::none, false}},
    {"planar", {std::nullopt, Projection::planar, false}},
    {"spherical", {std::nullopt, Projection::spherical, false}},
    {"cylindrical", {std::nullopt, Projection::cylindrical, false}},
    {"triplanar", {std::nullopt, Projection::planar, true}},
}};

inline constexpr std::array<NameRow<MappingSpace>, 2> kMappingSpaces = {{
    {"object", MappingSpace::object},
    {"world", MappingSpace::world},
}};

inline constexpr std::array<NameRow<CellMetric>, 3> kCellMetrics = {{
    {"euclidean", CellMetric::euclidean},
    {"manhattan", CellMetric::manhattan},
    {"chebyshev", CellMetric::chebyshev},
}};

inline constexpr std::array<NameRow<CellFeature>, 4> kCellFeatures = {{
    {"f1", CellFeature::f1},
    {"f2", CellFeature::f2},
    {"edges", CellFeature::edges},
    {"id", CellFeature::cell_id},
}};

inline constexpr std::array<NameRow<GradientShape>, 5> kGradientShapes = {{
    {"linear", GradientShape::linear},
    {"radial", GradientShape::radial},
    {"cylindrical", GradientShape::cylindrical},
    {"spherical", GradientShape::spherical},
    {"angular", GradientShape::angular},
}};

inline constexpr std::array<NameRow<RemapEnds>, 3> kRemapEnds = {{
    {"clamp", RemapEnds::clamp},
    {"smooth", RemapEnds::smooth},
    {"open", RemapEnds::open},
}};

inline constexpr std::array<NameRow<RampShape>, 3> kRampShapes = {{
    {"linear", RampShape::linear},
    {"smooth", RampShape::smooth},
    {"steps", RampShape::steps},
}};

}  // namespace hyades::core
