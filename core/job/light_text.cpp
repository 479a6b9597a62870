#include "core/job/old_lines.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {
namespace {

/// From when one struct held the keys of all types.
constexpr OldLine kOldLightLines[] = {
    {"at", kZeroBits},
    {"look_at", "00000000,bf800000,00000000"},
    {"direction", "00000000,bf800000,00000000"},
    {"color", kWhiteBits},
    {"power", "41200000"},
    {"irradiance", "3f800000"},
    {"angle", "3f07ae14"},
    {"blend", "3e4ccccd"},
    {"image", nullptr, kNoText},
    {"up"},
    {"fov"},
    {"step.*"},
    {"light_group"},
};

}  // namespace

void write_light(FieldWriter& out, const LightDesc& light) {
  write_desc(out, "light", light, kOldLightLines);
}

}  // namespace hyades::core
