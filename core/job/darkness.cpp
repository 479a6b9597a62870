#include "core/job/darkness.h"

#include <algorithm>
#include <variant>
#include <vector>

namespace hyades::core {

bool any_medium_glows(const Job& job) {
  return std::any_of(job.media.begin(), job.media.end(),
                     [](const MediumDesc& medium) { return medium.emission.has_value(); });
}

bool may_give_light(const Job& job) {
  bool emits = false;
  for_each_object(job, [&](const ObjectDesc& object) { emits |= object.emit.has_value(); });
  const auto shines = [](const MaterialDesc& material) {
    const auto* principled = std::get_if<PrincipledDesc>(&material.kind);
    return principled != nullptr && principled->emits();
  };
  return emits || !job.lights.empty() || job.environment || any_medium_glows(job) ||
         std::any_of(job.materials.begin(), job.materials.end(), shines);
}

}  // namespace hyades::core
