#include "core/geometry/ply_layout.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/color.h"

namespace hyades::core {
namespace {

struct SlotName {
  const char* name;
  PlySlot slot;
};

constexpr std::array<SlotName, 30> kNames{{
    {"x", kX},
    {"y", kY},
    {"z", kZ},
    {"nx", kNx},
    {"ny", kNy},
    {"nz", kNz},
    {"u", kU},
    {"v", kV},
    {"s", kU},
    {"t", kV},
    {"texture_u", kU},
    {"texture_v", kV},
    {"texture_s", kU},
    {"texture_t", kV},
    {"texcoord_u", kU},
    {"texcoord_v", kV},
    {"u1", kSecondU},
    {"v1", kSecondV},
    {"s1", kSecondU},
    {"t1", kSecondV},
    {"red", kRed},
    {"green", kGreen},
    {"blue", kBlue},
    {"alpha", kAlpha},
    {"tx", kTx},
    {"ty", kTy},
    {"tz", kTz},
    {"tw", kTw},
    {"texcoord1_u", kSecondU},
    {"texcoord1_v", kSecondV},
}};

PlySlot slot_named(const std::string& name) {
  for (const SlotName& known : kNames) {
    if (name == known.name) return known.slot;
  }
  return kIgnored;
}

}  // namespace

Result<PlyLayout> ply_layout(const PlyElement& vertices) {
  PlyLayout out;
  std::array<bool, kPlySlots> seen{};
  for (const PlyProperty& p : vertices.properties) {
    PlySlot slot = p.is_list ? kIgnored : slot_named(p.name);
    if (slot != kIgnored && std::exchange(seen[slot], true)) slot = kIgnored;
    out.slots.push_back(slot);
  }
  if (!seen[kX] || !seen[kY] || !seen[kZ]) return Error{"its vertices have no x, y and z"};
  out.has_normals = seen[kNx] && seen[kNy] && seen[kNz];
  out.has_uvs = seen[kU] && seen[kV];
  out.has_second_uvs = seen[kSecondU] && seen[kSecondV];
  out.has_colors = seen[kRed] && seen[kGreen] && seen[kBlue];
  out.has_tangents = seen[kTx] && seen[kTy] && seen[kTz];
  out.defaults[kAlpha] = 1.0F;
  out.defaults[kTw] = 1.0F;
  return out;
}

float ply_color(PlyType type, PlySlot slot, float value) {
  float largest = 0.0F;
  if (type == PlyType::uint8) largest = 255.0F;
  if (type == PlyType::uint16) largest = 65535.0F;
  if (largest == 0.0F) return value;
  if (slot == kAlpha) return value / largest;
  if (type == PlyType::uint16) return srgb_decode(value / largest);
  static const std::array<float, 256> codes = [] {
    std::array<float, 256> linear{};
    for (size_t i = 0; i < linear.size(); ++i)
      linear[i] = srgb_decode(static_cast<float>(i) / 255.0F);
    return linear;
  }();
  // Texts may hold numbers beyond the type that they name, and none at all.
  return codes[value > 0.0F ? static_cast<uint8_t>(std::min(value, largest)) : 0];
}

}  // namespace hyades::core
