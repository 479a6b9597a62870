#include "core/job/old_lines.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {
namespace {

/// From when one struct held the keys of all types.
constexpr OldLine kOldTextureLines[] = {
    {"a", kWhiteBits},
    {"b", kWhiteBits},
    {"amount", "3f000000"},
    {"image.file", kNoText},
    {"image.color_space", "4:auto"},
    {"image.wrap", "6:repeat"},
    {"image.wrap_v"},
    {"image.filter", "9:trilinear"},
    {"mapping.type", "7:default"},
    {"mapping.space", "6:object"},
    {"mapping.step.*"},
    {"mapping.blend", "3e99999a"},
    {"mapping.scale", kWhiteBits},
    {"mapping.offset", kZeroBits},
    {"noise.octaves", "1"},
    {"noise.lacunarity", "40000000"},
    {"noise.gain", "3f000000"},
    {"noise.time"},
    {"noise.distortion", "00000000"},
    {"metric", "9:euclidean"},
    {"feature", "2:f1"},
    {"jitter", "3f800000"},
    {"width", "3dcccccd"},
    {"shift", "3f000000"},
    {"line_softness", "00000000"},
    {"shape", "6:linear"},
    {"remap.low", "00000000"},
    {"remap.high", "3f800000"},
    {"remap.to_low", "00000000"},
    {"remap.to_high", "3f800000"},
    {"remap.ends", "5:clamp"},
    {"stop.*"},
    {"between", "6:linear"},
    {"exponent", "3f800000"},
    {"level", "3f000000"},
    {"softness", "00000000"},
    {"hue", "00000000"},
    {"saturation", "3f800000"},
    {"value", "3f800000"},
    {"channel", "5:color"},
};

}  // namespace

void write_texture(FieldWriter& out, const TextureDesc& texture) {
  write_desc(out, "texture", texture, kOldTextureLines);
}

}  // namespace hyades::core
