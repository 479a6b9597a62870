#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/udim.h"
#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class UdimTexture final : public Texture {
 public:
  UdimTexture(std::vector<UdimTile> tiles, const MappingDesc& mapping) : mapping_(mapping) {
    for (UdimTile& tile : tiles) {
      const auto place = static_cast<size_t>(tile.number - kFirstUdim);
      if (place < places_.size()) places_[place] = std::move(tile.texture);
    }
  }

  Rgb color(const TexturePoint& at) const override {
    const Texture* tile = tile_at(at);
    return tile != nullptr ? tile->color(at) : Rgb(0.0F);
  }

  float alpha(const TexturePoint& at) const override {
    const Texture* tile = tile_at(at);
    return tile != nullptr ? tile->alpha(at) : 0.0F;
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Texture* tile = tile_at(at);
    return tile != nullptr ? tile->gradient(at, weights) : ScalarGradient{};
  }

 private:
  const Texture* tile_at(const TexturePoint& at) const {
    const Vec3 uv = MappedPoint(mapping_, at).coordinate();
    if (!(uv.x >= 0.0F && uv.x <= static_cast<float>(kUdimColumns) && uv.y >= 0.0F &&
          uv.y <= static_cast<float>(kUdimRows))) {
      return nullptr;
    }
    // The outermost edges belong to the last tiles.
    const int column = std::min(static_cast<int>(uv.x), kUdimColumns - 1);
    const int row = std::min(static_cast<int>(uv.y), kUdimRows - 1);
    return places_[static_cast<size_t>(row * kUdimColumns + column)].get();
  }

  std::array<TexturePtr, kUdimColumns * kUdimRows> places_;
  MappingDesc mapping_;
};

}  // namespace

TexturePtr make_udim_texture(std::vector<UdimTile> tiles, const MappingDesc& mapping) {
  return std::make_shared<UdimTexture>(std::move(tiles), mapping);
}

}  // namespace hyades::core
