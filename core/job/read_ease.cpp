#include <array>
#include <cstddef>
#include <string>

#include "core/job/read_components.h"

namespace hyades::core {

Ease read_ease(MapReader& reader) {
  static const std::array<std::string, 6> kNames = {"linear", "smooth", "step",
                                                    "in",     "out",    "spline"};
  std::string name = kNames[0];
  reader.choice("ease", name, kNames);
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<Ease>(i);
  }
  return Ease::linear;
}

Repeat read_repeat(MapReader& reader) {
  static const std::array<std::string, 3> kNames = {"none", "loop", "mirror"};
  std::string name = kNames[0];
  reader.choice("repeat", name, kNames);
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<Repeat>(i);
  }
  return Repeat::none;
}

}  // namespace hyades::core
