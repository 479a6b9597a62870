#include "core/scene/texture_makers.h"

#include <utility>
#include <variant>

#include "core/base/udim.h"
#include "core/scene/texture_kind_makers.h"
#include "core/scene/texture_mapping.h"
#include "core/scene/texture_names.h"

namespace hyades::core {
namespace {

Result<TexturePtr> make_texture(const textures::Constant& desc, Appearance& looks) {
  return looks.color_texture(desc.value);
}

/// One file, on `mapping`.
Result<TexturePtr> make_file(const std::string& file, const ImageUse& use, TextureFilter filter,
                             const MappingDesc& mapping, Appearance& looks) {
  auto image = looks.cache().pyramid(file, use);
  if (!image) return image.error();
  return make_image_texture(*image, {filter, mapping, looks.view()});
}

/// All files of a UDIM pattern, each in its place.
Result<TexturePtr> make_tiles(const std::string& pattern, const ImageUse& use, TextureFilter filter,
                              const MappingDesc& mapping, Appearance& looks) {
  const auto numbers = looks.cache().udim(pattern);
  if (!numbers) return numbers.error();
  std::vector<UdimTile> tiles;
  for (const int number : **numbers) {
    MappingDesc in_place = mapping;
    const int index = number - kFirstUdim;
    in_place.offset -= Vec3(index % kUdimColumns, index / kUdimColumns, 0.0F);
    auto tile = make_file(udim_file(pattern, number), use, filter, in_place, looks);
    if (!tile) return tile;
    tiles.push_back({number, *tile});
  }
  return make_udim_texture(std::move(tiles), mapping);
}

Result<TexturePtr> make_texture(const textures::Image& desc, Appearance& looks) {
  const auto use = image_use_of(desc);
  if (!use) return use.error();
  const auto filter = look_up(kFilters, desc.filter, "filter of textures");
  if (!filter) return filter.error();
  const auto channel = look_up(kChannels, desc.channel, "channel");
  if (!channel) return channel.error();
  const auto make = is_udim(desc.file) ? make_tiles : make_file;
  auto image =
      make_mapped(desc, textures::Image::kTraits.on_uv, looks, [&](const MappingDesc& mapping) {
        return make(desc.file, *use, (*filter)->value, mapping, looks);
      });
  if (!image || !(*channel)->value) return image;
  return make_channel_texture(*image, *(*channel)->value);
}

Result<TexturePtr> make_texture(const textures::VertexColor& desc, Appearance& /*looks*/) {
  const auto channel = look_up(kChannels, desc.channel, "channel");
  if (!channel) return channel.error();
  const TexturePtr colors = make_vertex_color_texture();
  return (*channel)->value ? make_channel_texture(colors, *(*channel)->value) : colors;
}

}  // namespace

Result<TexturePtr> make_texture(const TextureDesc& desc, Appearance& looks) {
  return std::visit([&](const auto& kind) { return make_texture(kind, looks); }, desc.kind);
}

Result<ImageUse> image_use_of(const textures::Image& desc) {
  const auto space = look_up(kColorSpaces, desc.color_space, "color_space");
  if (!space) return space.error();
  const auto wrap = look_up(kWraps, desc.wrap, "wrap");
  if (!wrap) return wrap.error();
  const auto upwards = look_up(kWraps, desc.wrap_v, "wrap");
  if (!upwards) return upwards.error();
  // Tiles lie side by side: none repeats.
  const WrapModes wraps((*wrap)->value, (*upwards)->value);
  return ImageUse{(*space)->value, is_udim(desc.file) ? WrapMode::clamp : wraps};
}

std::vector<std::string> made_color_spaces() { return names_of(kColorSpaces); }
std::vector<std::string> made_wraps() { return names_of(kWraps); }
std::vector<std::string> made_texture_filters() { return names_of(kFilters); }
std::vector<std::string> made_mappings() { return names_of(kMappings); }
std::vector<std::string> made_mapping_spaces() { return names_of(kMappingSpaces); }
std::vector<std::string> made_channels() { return names_of(kChannels); }
std::vector<std::string> made_cell_metrics() { return names_of(kCellMetrics); }
std::vector<std::string> made_cell_features() { return names_of(kCellFeatures); }
std::vector<std::string> made_gradient_shapes() { return names_of(kGradientShapes); }
std::vector<std::string> made_remap_ends() { return names_of(kRemapEnds); }
std::vector<std::string> made_ramp_shapes() { return names_of(kRampShapes); }

}  // namespace hyades::core
