#include "core/scene/texture_mapping.h"

#include <array>
#include <cstddef>
#include <utility>

#include "core/scene/texture_names.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

Mat4 scaling(float factor) {
  Mat4 m(factor);
  m[3].w = 1.0F;
  return m;
}

}  // namespace

Result<TexturePtr> make_mapped(const textures::Mapped& desc, bool on_uv, const Appearance& looks,
                               const std::function<Result<TexturePtr>(const MappingDesc&)>& make) {
  const textures::Mapping& says = desc.mapping;
  const auto kind = look_up(kMappings, says.type, "mapping");
  if (!kind) return kind.error();
  const auto space = look_up(kMappingSpaces, says.space, "space of mappings");
  if (!space) return space.error();
  const MappingKind& named = (*kind)->value;
  MappingDesc mapping;
  mapping.projection = named.projection;
  const MappingSpace preferred = on_uv ? MappingSpace::uv : MappingSpace::object;
  mapping.space =
      named.projection != Projection::none ? (*space)->value : named.space.value_or(preferred);
  mapping.scale = desc.scale.at(looks.time());
  mapping.offset = desc.offset.at(looks.time());
  mapping.transform = transform_at(says.transform, Animated<Vec3>(Vec3(0.0F)), looks.time());
  // World positions are in metres, the job's lengths and scales in its own unit.
  if (mapping.space == MappingSpace::world)
    mapping.transform = mapping.transform * scaling(1.0F / looks.units());
  if (!named.triplanar) return make(mapping);

  const Mat4 placed = mapping.transform;
  std::array<TexturePtr, 3> planes;
  for (int axis = 0; axis < 3; ++axis) {
    mapping.transform = plane_across(axis) * placed;
    auto plane = make(mapping);
    if (!plane) return plane;
    planes[static_cast<size_t>(axis)] = *plane;
  }
  mapping.transform = placed;
  return make_triplanar_texture(std::move(planes), mapping, says.blend.at(looks.time()));
}

}  // namespace hyades::core
