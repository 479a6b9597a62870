#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/textures/mapping.h"
#include "core/textures/pattern.h"
#include "core/textures/pixel_view.h"
#include "core/textures/pyramid.h"
#include "core/textures/texture.h"

/// One maker per kind of texture. Composite textures hold their inputs alive.
namespace hyades::core {

using TexturePtr = std::shared_ptr<const Texture>;

TexturePtr make_constant_texture(const Rgb& value);

/// The interpolated colours of a mesh's vertices; white, with alpha 1, where there are none.
TexturePtr make_vertex_color_texture();

/// How an image is read between its pixels, and where a pixel of the picture covers many of them.
enum class TextureFilter {
  trilinear,    ///< the two sizes of the image nearest to what is covered, at its longest
  anisotropic,  ///< several of those along what is covered, each as wide as its shortest
  bilinear,     ///< the image alone: aliases from afar
  nearest,      ///< its pixels
};

struct ImageTextureDesc {
  TextureFilter filter = TextureFilter::trilinear;
  MappingDesc mapping{.space = MappingSpace::uv};
  /// Who sees the surfaces; null: nobody, and images are read as finely as they can be.
  std::shared_ptr<const PixelView> view;
};

/// Coordinate (0, 0) is the lower left corner of the image, (1, 1) the upper right. Texel centres
/// lie half a texel inside. An image without pixels is black. Derivatives are those of the
/// interpolation, what is covered taken as it is at the place.
TexturePtr make_image_texture(PyramidPtr image, const ImageTextureDesc& desc);

/// Colour a where floor(x) + floor(y) + floor(z) of the mapped coordinate is even, else b (flat
/// mappings: z = 0).
TexturePtr make_checker_texture(TexturePtr a, TexturePtr b, const MappingDesc& mapping);

/// a where the pattern is 0, b where it is 1, mixed between.
TexturePtr make_pattern_texture(TexturePtr a, TexturePtr b, PatternPtr pattern,
                                const MappingDesc& mapping);

// Arithmetic, channel by channel.

/// input times factor.
TexturePtr make_scale_texture(TexturePtr input, TexturePtr factor);
TexturePtr make_sum_texture(TexturePtr a, TexturePtr b);
/// a over b; 0 where b is 0.
TexturePtr make_quotient_texture(TexturePtr a, TexturePtr b);
/// The greater of a and b, or the lesser.
TexturePtr make_extreme_texture(TexturePtr a, TexturePtr b, bool greater);
/// (1 - w) a + w b with w the number of `amount`, held within 0..1.
TexturePtr make_mix_texture(TexturePtr a, TexturePtr b, TexturePtr amount);
/// 1 - input.
TexturePtr make_invert_texture(TexturePtr input);

/// What becomes of numbers outside of low..high.
enum class RemapEnds {
  clamp,   ///< to_low or to_high
  smooth,  ///< likewise, and between them no straight line but one without kinks
  open,    ///< the line goes on
};

struct RemapDesc {
  float low = 0.0F;
  float high = 1.0F;
  float to_low = 0.0F;
  float to_high = 1.0F;
  RemapEnds ends = RemapEnds::clamp;
};

/// low..high becomes to_low..to_high (a step where low = high).
TexturePtr make_remap_texture(TexturePtr input, const RemapDesc& desc);
/// input to the power of `exponent` >= 0; what is negative counts as 0.
TexturePtr make_power_texture(TexturePtr input, float exponent);
/// 0 below `level`, 1 above, smoothly over a width of `softness`.
TexturePtr make_threshold_texture(TexturePtr input, float level, float softness);

/// A colour of a ramp and the number that it stands for.
struct RampStop {
  float at = 0.0F;
  TexturePtr color;
};

enum class RampShape { linear, smooth, steps };

/// The colour that the input's number has among `stops`: mixed from its neighbours', that of the
/// first and last beyond them; with `steps` that of the stop before it.
TexturePtr make_ramp_texture(TexturePtr input, std::vector<RampStop> stops, RampShape shape);

struct HueDesc {
  float hue = 0.0F;         ///< turn, degrees: red to green to blue
  float saturation = 1.0F;  ///< factor; full saturation at most
  float value = 1.0F;       ///< factor
};

/// Hue, saturation and value of linear red, green and blue, changed.
TexturePtr make_hue_texture(TexturePtr input, const HueDesc& desc);

enum class Channel { red, green, blue, alpha, luminance };

/// One number of the input as a grey.
TexturePtr make_channel_texture(TexturePtr input, Channel channel);

/// What to transform by before a planar projection so that it looks along x, y or z (0, 1, 2), with
/// y upwards (looking along y: -z).
Mat4 plane_across(int axis);

/// Three textures seen along x, y and z of the mapping's transformed space, by how much the surface
/// faces each way. `blend` 0..1: how softly one goes over into the other. Derivatives leave out
/// those of the shares.
TexturePtr make_triplanar_texture(std::array<TexturePtr, 3> planes, const MappingDesc& mapping,
                                  float blend);

/// A texture for one unit square of uv; number: core/base/udim.h.
struct UdimTile {
  int number = 1001;
  TexturePtr texture;
};

/// Tiles side by side; black, with alpha 0, where there is none. `mapping` leads to uv.
TexturePtr make_udim_texture(std::vector<UdimTile> tiles, const MappingDesc& mapping);

}  // namespace hyades::core
