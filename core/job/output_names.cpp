#include "core/job/output_names.h"

#include <array>

namespace hyades::core {

std::span<const std::string> layer_names() {
  static const std::array<std::string, 7> names = {"beauty", "alpha",    "depth",  "albedo",
                                                   "normal", "variance", "samples"};
  return names;
}

std::span<const std::string> tone_map_names() {
  static const std::array<std::string, 4> names = {"srgb", "filmic", "aces", "linear"};
  return names;
}

}  // namespace hyades::core
