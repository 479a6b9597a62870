#include "core/job/texture_desc.h"

namespace hyades::core {

std::vector<std::string> textures_used(const TextureDesc& texture) {
  std::vector<std::string> names = {texture.a.texture, texture.b.texture, texture.amount.texture};
  for (const TextureStop& stop : texture.stops) names.push_back(stop.color.texture);
  return names;
}

}  // namespace hyades::core
