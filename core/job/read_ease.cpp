#include <array>

#include "core/job/read_components.h"

namespace hyades::core {

Ease read_ease(MapReader& reader) {
  static const std::array<std::string, 5> kNames = {"linear", "smooth", "step", "in", "out"};
  std::string name = kNames[0];
  reader.choice("ease", name, kNames);
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<Ease>(i);
  }
  return Ease::linear;
}

}  // namespace hyades::core
