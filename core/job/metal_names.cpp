#include "core/job/metal_names.h"

namespace hyades::core {

const std::vector<std::string>& metal_names_in_jobs() {
  static const std::vector<std::string> names = {
      "aluminium", "brass",     "chromium", "cobalt", "copper",   "gold",    "iron",
      "nickel",    "palladium", "platinum", "silver", "titanium", "tungsten"};
  return names;
}

}  // namespace hyades::core
