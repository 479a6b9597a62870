#include "core/geometry/ply_layout.h"

#include <string>
#include <utility>

namespace hyades::core {
namespace {

PlySlot slot_named(const std::string& name) {
  static const std::array<std::pair<const char*, PlySlot>, 16> known{{
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
  }};
  for (const auto& [text, slot] : known) {
    if (name == text) return slot;
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
  return out;
}

}  // namespace hyades::core
