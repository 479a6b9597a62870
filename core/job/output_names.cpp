#include "core/job/output_names.h"

#include <array>
#include <cstddef>

#include "core/film/layout.h"
#include "core/image/tone_map.h"

namespace hyades::core {

std::span<const std::string> layer_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"beauty", "alpha",  "depth",    "position", "normal",
                                    "albedo", "motion", "variance", "samples",  "components"};
    for (const std::string& name : unfolded("components")) all.push_back(name);
    for (const char* name :
         {"light_groups", "object_id", "material_id", "crypto_object", "crypto_material"}) {
      all.emplace_back(name);
    }
    return all;
  }();
  return names;
}

std::vector<std::string> unfolded(const std::string& layer) {
  if (layer != "components") return {layer};
  std::vector<std::string> names;
  for (size_t i = 0; i < kLightComponents; ++i)
    names.emplace_back(name_of(static_cast<LightComponent>(i)));
  return names;
}

std::span<const std::string> tone_map_names() { return tone_curve_names(); }

std::span<const std::string> denoise_names() {
  static const std::array<std::string, 4> names = {"true", "false", "features", "oidn"};
  return names;
}

}  // namespace hyades::core
